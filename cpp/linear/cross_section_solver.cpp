#include "linear/cross_section_solver.hpp"

#include "core/check.hpp"
#include "core/parallel.hpp"
#include "linear/axial_fourier.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <complex>
#include <stdexcept>
#include <string>
#include <utility>

namespace mpsdem::linear {

namespace {

using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Stride = Eigen::OuterStride<>;
using Block = Eigen::Map<Matrix, Eigen::Unaligned, Stride>;

constexpr std::size_t block_columns = 64; // of the spectra, about, that one body takes
constexpr Real free_limit = 1e-9;         // [-] of the largest eigenvalue: below it, zero
constexpr Real shared_limit = 1e-9; // [-] of the largest entry: what mirrors may leave between

Eigen::Index signed_of(std::size_t n) {
    return static_cast<Eigen::Index>(n);
}

/// A over B, in the rows and columns of the classes.
Matrix by_classes(std::span<const Real> interior, std::span<const Real> wall,
                  const ParityClasses& classes) {
    const std::span<const Index> row = classes.row();
    const std::size_t all = row.size();
    Matrix whole(signed_of(all), signed_of(all));
    for (std::size_t i = 0; i < all; ++i) {
        const Real* from =
            i * all < interior.size() ? &interior[i * all] : &wall[i * all - interior.size()];
        for (std::size_t j = 0; j < all; ++j) whole(row[i], row[j]) = from[j];
    }
    for (int side = 0; side < 2; ++side) {
        classes.transform(whole.data(), all, 0, all);
        whole.transposeInPlace();
    }
    return whole;
}

/// Whether nothing of note lies between the classes.
bool are_shared(const Matrix& whole, const ParityClasses& classes) {
    const std::size_t all = classes.row().size();
    Real between[2] = {}, within[2] = {}; // of A, of B
    for (const ParityClasses::Class& c : classes.classes()) {
        for (std::size_t i = c.begin; i < c.begin + c.size(); ++i) {
            const std::size_t at = i < c.begin + c.interior ? 0 : 1;
            for (std::size_t j = 0; j < all; ++j) {
                Real& most = j >= c.begin && j < c.begin + c.size() ? within[at] : between[at];
                most = std::max(most, std::abs(whole(signed_of(i), signed_of(j))));
            }
        }
    }
    return between[0] <= shared_limit * within[0] && between[1] <= shared_limit * within[1];
}

/// One class of nodes in its own eigenbasis.
struct Modes {
    ParityClasses::Class rows;
    Matrix to_modes;                   // interior x interior
    Matrix wall_to_modes;              // interior x wall
    Matrix from_modes;                 // all x interior
    Matrix wall_to_wall;               // wall x wall
    std::vector<Real> real, imaginary; // [1/m2] of each mode; a pair stands as two equal entries

    /// `scale`: of the transform back along the axis, which has none.
    Modes(const ParityClasses::Class& rows, const Matrix& whole, Real scale);
};

Modes::Modes(const ParityClasses::Class& of_class, const Matrix& whole, Real scale)
    : rows(of_class) {
    const Eigen::Index first = signed_of(rows.begin), n = signed_of(rows.interior),
                       w = signed_of(rows.wall);
    const auto a = whole.block(first, first, n, n + w);
    const auto b = whole.block(first + n, first, w, n + w);
    // Of the wall's values: b_w's share, and the interior's.
    const Matrix inverse = b.rightCols(w).partialPivLu().inverse();
    const Matrix from_interior = -inverse * b.leftCols(n);
    const Eigen::MatrixXd condensed = a.leftCols(n) + a.rightCols(w) * from_interior;
    const Eigen::EigenSolver<Eigen::MatrixXd> eigen(condensed);
    if (eigen.info() != Eigen::Success)
        throw std::runtime_error("CrossSectionSolver: no eigenbasis was found");
    const Eigen::MatrixXd& vectors = eigen.pseudoEigenvectors();
    to_modes = scale * vectors.inverse();
    wall_to_modes = -to_modes * (a.rightCols(w) * inverse);
    from_modes.resize(n + w, n);
    from_modes.topRows(n) = vectors;
    from_modes.bottomRows(w) = from_interior * vectors;
    wall_to_wall = scale * inverse;
    for (const std::complex<Real>& value : eigen.eigenvalues()) {
        real.push_back(value.real());
        imaginary.push_back(value.imag());
    }
}

} // namespace

struct CrossSectionSolver::Basis {
    Basis(ParityClasses of_nodes, std::size_t interior_count, std::size_t stations)
        : classes(std::move(of_nodes)), interior(interior_count),
          fourier(classes.row().size(), stations), columns(fourier.columns()),
          spectra(classes.row().size() * columns), modes(spectra.size()) {}

    void divide(const Modes& of_class, Block& q, std::size_t first) const;
    void solve_class(const Modes& of_class, WallSource source, std::size_t first,
                     std::size_t count);

    ParityClasses classes;
    std::size_t interior;
    AxialFourier fourier;
    std::size_t columns;
    std::vector<Modes> by_class;
    std::vector<Real> axial; // [1/m2] of each column of the spectra
    Real smallest = 0;       // [1/m2] a divisor below it counts as zero
    AlignedVector<Real> spectra, modes;
};

CrossSectionSolver::CrossSectionSolver(std::span<const Real> interior, std::span<const Real> wall,
                                       std::size_t interior_count, std::size_t wall_count,
                                       std::span<const Real> axial, std::size_t stations,
                                       const Mirrors& mirrors) {
    const std::size_t all = interior_count + wall_count;
    require(interior.size() == interior_count * all && wall.size() == wall_count * all,
            "CrossSectionSolver: the operators must have one column per node");
    require(stations > 0 && stations % lane_count == 0,
            "CrossSectionSolver: stations must be a multiple of 4");
    require(axial.size() == stations / 2 + 1,
            "CrossSectionSolver: axial must have one value per wave, stations / 2 + 1");
    ParityClasses classes(interior_count, wall_count, mirrors);
    Matrix whole = by_classes(interior, wall, classes);
    if (!are_shared(whole, classes)) {
        classes = ParityClasses(interior_count, wall_count, {});
        whole = by_classes(interior, wall, classes);
    }
    basis_ = std::make_unique<Basis>(std::move(classes), interior_count, stations);
    Basis& basis = *basis_;
    Real largest = 0, highest = 0;
    for (const ParityClasses::Class& rows : basis.classes.classes()) {
        // the transforms along the axis are not scaled
        const Modes& modes =
            basis.by_class.emplace_back(rows, whole, 1 / static_cast<Real>(stations));
        for (std::size_t q = 0; q < modes.real.size(); ++q) {
            largest = std::max(largest, std::hypot(modes.real[q], modes.imaginary[q]));
            highest = std::max(highest, modes.real[q]);
        }
    }
    if (!(highest < free_limit * largest)) {
        throw std::runtime_error("CrossSectionSolver: the operator has a growing mode, " +
                                 std::to_string(highest) + " 1/m2");
    }
    basis.smallest = free_limit * largest;
    basis.axial.assign(basis.columns, axial.back());
    for (std::size_t m = 0; m < axial.size(); ++m)
        basis.axial[2 * m] = basis.axial[2 * m + 1] = axial[m];
}

CrossSectionSolver::CrossSectionSolver(CrossSectionSolver&&) noexcept = default;
CrossSectionSolver& CrossSectionSolver::operator=(CrossSectionSolver&&) noexcept = default;
CrossSectionSolver::~CrossSectionSolver() = default;

/// Of each mode, by its eigenvalue and the axial one.
void CrossSectionSolver::Basis::divide(const Modes& of_class, Block& q, std::size_t first) const {
    const auto count = static_cast<std::size_t>(q.cols());
    for (std::size_t mode = 0; mode < of_class.real.size(); ++mode) {
        Real* row = &q(signed_of(mode), 0);
        const Real re = of_class.real[mode], im = of_class.imaginary[mode];
        if (im == 0) {
            for (std::size_t c = 0; c < count; ++c) {
                const Real divisor = re + axial[first + c];
                row[c] = std::abs(divisor) > smallest ? row[c] / divisor : 0;
            }
            continue;
        }
        Real* next = &q(signed_of(++mode), 0);
        for (std::size_t c = 0; c < count; ++c) {
            const Real shifted = re + axial[first + c];
            const Real scale = 1 / (shifted * shifted + im * im);
            const Real one = row[c], two = next[c];
            row[c] = scale * (shifted * one - im * two);
            next[c] = scale * (im * one + shifted * two);
        }
    }
}

void CrossSectionSolver::Basis::solve_class(const Modes& of_class, WallSource source,
                                            std::size_t first, std::size_t count) {
    const auto& rows = of_class.rows;
    const Eigen::Index n = signed_of(rows.interior), w = signed_of(rows.wall), c = signed_of(count);
    const Stride stride(signed_of(columns));
    const std::size_t begin = rows.begin * columns + first;
    const std::size_t wall_begin = begin + rows.interior * columns;
    Block b(spectra.data() + begin, n, c, stride);
    Block at_wall(spectra.data() + wall_begin, w, c, stride);
    Block all(spectra.data() + begin, n + w, c, stride);
    Block q(modes.data() + begin, n, c, stride);
    Block kept(modes.data() + wall_begin, w, c, stride);
    q.noalias() = of_class.to_modes * b;
    if (source == WallSource::given) {
        q.noalias() += of_class.wall_to_modes * at_wall;
        kept.noalias() = of_class.wall_to_wall * at_wall;
    }
    divide(of_class, q, first);
    all.noalias() = of_class.from_modes * q;
    if (source == WallSource::given) at_wall += kept;
}

void CrossSectionSolver::solve(WallSource source, int threads, Field& values) {
    Basis& basis = *basis_;
    const std::span<const Index> row = basis.classes.row();
    const std::span<const Index> with_source =
        source == WallSource::given ? row : row.first(basis.interior);
    basis.fourier.forward(values, with_source, threads, basis.spectra);
    // an even number of blocks, so that two threads have the same work
    const std::size_t pairs = (basis.columns + block_columns) / (2 * block_columns);
    const std::size_t blocks = std::max<std::size_t>(1, 2 * pairs);
    const std::size_t registers = basis.columns / lane_count;
    parallel_for(blocks, threads, [&](std::size_t k) {
        const std::size_t first = lane_count * (registers * k / blocks);
        const std::size_t count = lane_count * (registers * (k + 1) / blocks) - first;
        basis.classes.transform(basis.spectra.data(), basis.columns, first, count);
        for (const Modes& of_class : basis.by_class)
            basis.solve_class(of_class, source, first, count);
        basis.classes.transform(basis.spectra.data(), basis.columns, first, count);
    });
    basis.fourier.inverse(basis.spectra, row, threads, values);
}

} // namespace mpsdem::linear
