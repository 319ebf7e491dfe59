#include "linear/cross_section_solver.hpp"

#include "core/check.hpp"
#include "core/parallel.hpp"
#include "linear/axial_fourier.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <stdexcept>
#include <string>

namespace mpsdem::linear {

namespace {

using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Stride = Eigen::OuterStride<>;
using Block = Eigen::Map<Matrix, Eigen::Unaligned, Stride>;

constexpr std::size_t block_columns = 64; // of the spectra, about, that one body takes
constexpr Real free_limit = 1e-9;         // [-] of the largest eigenvalue: below it, zero

Eigen::Index signed_of(std::size_t n) {
    return static_cast<Eigen::Index>(n);
}

} // namespace

struct CrossSectionSolver::Basis {
    Basis(std::size_t interior_count, std::size_t wall_count, std::size_t stations)
        : interior(interior_count), wall(wall_count),
          fourier(interior_count + wall_count, stations), columns(fourier.columns()),
          spectra((interior_count + wall_count) * columns), modes(interior_count * columns),
          wall_part(wall_count * columns) {}

    void divide(Block& q, std::size_t first) const;
    void solve_columns(WallSource source, std::size_t first, std::size_t count);

    std::size_t interior, wall;
    AxialFourier fourier;
    std::size_t columns;
    Matrix to_modes;                   // interior x interior
    Matrix wall_to_modes;              // interior x wall
    Matrix from_modes;                 // all x interior
    Matrix wall_to_wall;               // wall x wall
    std::vector<Real> real, imaginary; // [1/m2] of each mode; a pair stands as two equal entries
    std::vector<Real> axial;           // [1/m2] of each column of the spectra
    Real smallest = 0;                 // [1/m2] a divisor below it counts as zero
    AlignedVector<Real> spectra, modes, wall_part;
};

CrossSectionSolver::CrossSectionSolver(std::span<const Real> interior, std::span<const Real> wall,
                                       std::size_t interior_count, std::size_t wall_count,
                                       std::span<const Real> axial, std::size_t stations) {
    const std::size_t all = interior_count + wall_count;
    require(interior.size() == interior_count * all && wall.size() == wall_count * all,
            "CrossSectionSolver: the operators must have one column per node");
    require(stations > 0 && stations % lane_count == 0,
            "CrossSectionSolver: stations must be a multiple of 4");
    require(axial.size() == stations / 2 + 1,
            "CrossSectionSolver: axial must have one value per wave, stations / 2 + 1");
    basis_ = std::make_unique<Basis>(interior_count, wall_count, stations);
    Basis& basis = *basis_;

    const Eigen::Index n = signed_of(interior_count), w = signed_of(wall_count);
    const Eigen::Map<const Matrix> a(interior.data(), n, n + w), b(wall.data(), w, n + w);
    const Eigen::PartialPivLU<Matrix> at_wall(b.rightCols(w));
    // Of the wall's values: b_w's share, and the interior's.
    const Matrix inverse = at_wall.inverse();
    const Matrix from_interior = -inverse * b.leftCols(n);
    const Matrix condensed = a.leftCols(n) + a.rightCols(w) * from_interior;
    const Eigen::EigenSolver<Eigen::MatrixXd> eigen(condensed);
    const bool decomposed = eigen.info() == Eigen::Success;
    if (!decomposed) throw std::runtime_error("CrossSectionSolver: no eigenbasis was found");

    const Eigen::VectorXcd& values = eigen.eigenvalues();
    const Real largest = values.cwiseAbs().maxCoeff();
    const Real highest = values.real().maxCoeff();
    if (!(highest < free_limit * largest)) {
        throw std::runtime_error("CrossSectionSolver: the operator has a growing mode, " +
                                 std::to_string(highest) + " 1/m2");
    }
    const Eigen::MatrixXd& vectors = eigen.pseudoEigenvectors();
    const Real share = 1 / static_cast<Real>(stations); // the transforms are not scaled
    basis.smallest = free_limit * largest;
    basis.to_modes = share * vectors.inverse();
    basis.wall_to_modes = -basis.to_modes * (a.rightCols(w) * inverse);
    basis.from_modes.resize(n + w, n);
    basis.from_modes.topRows(n) = vectors;
    basis.from_modes.bottomRows(w) = from_interior * vectors;
    basis.wall_to_wall = share * inverse;
    for (Eigen::Index q = 0; q < n; ++q) {
        basis.real.push_back(values[q].real());
        basis.imaginary.push_back(values[q].imag());
    }
    basis.axial.assign(basis.columns, axial.back());
    for (std::size_t m = 0; m < axial.size(); ++m)
        basis.axial[2 * m] = basis.axial[2 * m + 1] = axial[m];
}

CrossSectionSolver::CrossSectionSolver(CrossSectionSolver&&) noexcept = default;
CrossSectionSolver& CrossSectionSolver::operator=(CrossSectionSolver&&) noexcept = default;
CrossSectionSolver::~CrossSectionSolver() = default;

/// Of each mode, by its eigenvalue and the axial one.
void CrossSectionSolver::Basis::divide(Block& q, std::size_t first) const {
    const auto count = static_cast<std::size_t>(q.cols());
    for (std::size_t mode = 0; mode < interior; ++mode) {
        Real* row = &q(signed_of(mode), 0);
        const Real re = real[mode], im = imaginary[mode];
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

void CrossSectionSolver::Basis::solve_columns(WallSource source, std::size_t first,
                                              std::size_t count) {
    const Eigen::Index n = signed_of(interior), w = signed_of(wall), c = signed_of(count);
    const Stride stride(signed_of(columns));
    Block b(spectra.data() + first, n, c, stride);
    Block at_wall(spectra.data() + interior * columns + first, w, c, stride);
    Block all(spectra.data() + first, n + w, c, stride);
    Block q(modes.data() + first, n, c, stride);
    Block kept(wall_part.data() + first, w, c, stride);
    q.noalias() = to_modes * b;
    if (source == WallSource::given) {
        q.noalias() += wall_to_modes * at_wall;
        kept.noalias() = wall_to_wall * at_wall;
    }
    divide(q, first);
    all.noalias() = from_modes * q;
    if (source == WallSource::given) at_wall += kept;
}

void CrossSectionSolver::solve(WallSource source, int threads, Field& values) {
    Basis& basis = *basis_;
    const std::size_t all = basis.interior + basis.wall;
    const std::size_t with_source = source == WallSource::given ? all : basis.interior;
    basis.fourier.forward(values, with_source, threads, basis.spectra);
    // an even number of blocks, so that two threads have the same work
    const std::size_t pairs = (basis.columns + block_columns) / (2 * block_columns);
    const std::size_t blocks = std::max<std::size_t>(1, 2 * pairs);
    const std::size_t registers = basis.columns / lane_count;
    parallel_for(blocks, threads, [&](std::size_t k) {
        const std::size_t first = lane_count * (registers * k / blocks);
        const std::size_t last = lane_count * (registers * (k + 1) / blocks);
        basis.solve_columns(source, first, last - first);
    });
    basis.fourier.inverse(basis.spectra, all, threads, values);
}

} // namespace mpsdem::linear
