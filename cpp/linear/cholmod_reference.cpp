#include "linear/cholmod_reference.hpp"

#include <stdexcept>

#ifdef MPSDEM_WITH_CHOLMOD

#include <cholmod.h>

namespace mpsdem::linear {

struct CholmodReference::Factor {
    explicit Factor(Clusters c) : clusters(std::move(c)) { cholmod_l_start(&common); }
    Factor(const Factor&) = delete;
    Factor& operator=(const Factor&) = delete;
    ~Factor() {
        cholmod_l_free_factor(&factor, &common);
        cholmod_l_finish(&common);
    }

    Clusters clusters;
    std::size_t size = 0;
    cholmod_common common{};
    cholmod_factor* factor = nullptr;
};

namespace {

/// The upper triangle by columns, which is the lower triangle by rows.
cholmod_sparse* upper_triangle(const LaplacianMatrix& matrix, const Clusters& clusters,
                               cholmod_common& common) {
    const std::size_t n = matrix.size();
    std::vector<char> pinned(n, 0);
    for (std::size_t c = 0; c < clusters.floating_count(); ++c) pinned[clusters.floating(c)[0]] = 1;

    cholmod_sparse* upper =
        cholmod_l_allocate_sparse(n, n, matrix.column().size() + n, 0, 1, 1, CHOLMOD_REAL, &common);
    if (upper == nullptr) throw std::bad_alloc();
    auto* start = static_cast<SuiteSparse_long*>(upper->p);
    auto* row = static_cast<SuiteSparse_long*>(upper->i);
    auto* value = static_cast<Real*>(upper->x);
    SuiteSparse_long entries = 0;
    for (std::size_t i = 0; i < n; ++i) {
        start[i] = entries;
        for (std::size_t k = matrix.first(i); k < matrix.last(i); ++k) {
            if (matrix.column()[k] >= i) continue;
            row[entries] = matrix.column()[k];
            value[entries++] = -static_cast<Real>(matrix.weight()[k]);
        }
        const Real diagonal = matrix.diagonal()[i];
        row[entries] = static_cast<SuiteSparse_long>(i);
        value[entries++] = diagonal + (pinned[i] ? std::max(diagonal, 1.) : 0);
    }
    start[n] = entries;
    return upper;
}

} // namespace

CholmodReference::CholmodReference(const LaplacianMatrix& matrix, const Clusters& clusters)
    : factor_(std::make_unique<Factor>(clusters)) {
    cholmod_common& common = factor_->common;
    common.print = 0;
    factor_->size = matrix.size();
    cholmod_sparse* upper = upper_triangle(matrix, clusters, common);
    factor_->factor = cholmod_l_analyze(upper, &common);
    const bool done = factor_->factor != nullptr &&
                      cholmod_l_factorize(upper, factor_->factor, &common) != 0 &&
                      common.status == CHOLMOD_OK;
    cholmod_l_free_sparse(&upper, &common);
    if (!done) {
        throw std::runtime_error("CholmodReference: the matrix is not definite, not symmetric, or "
                                 "too large for the memory (CHOLMOD status " +
                                 std::to_string(common.status) + ")");
    }
}

void CholmodReference::solve(std::span<const Real> b, std::span<Real> x) const {
    require(b.size() == factor_->size && x.size() == factor_->size,
            "CholmodReference: right_hand_side must have one value per row of the matrix");
    cholmod_common& common = factor_->common;
    cholmod_dense* right = cholmod_l_allocate_dense(b.size(), 1, b.size(), CHOLMOD_REAL, &common);
    if (right == nullptr) throw std::bad_alloc();
    const std::span projected(static_cast<Real*>(right->x), b.size());
    std::ranges::copy(b, projected.begin());
    factor_->clusters.remove_means(projected, 1);
    cholmod_dense* solution = cholmod_l_solve(CHOLMOD_A, factor_->factor, right, &common);
    cholmod_l_free_dense(&right, &common);
    if (solution == nullptr) throw std::runtime_error("CholmodReference: CHOLMOD did not solve");
    std::copy_n(static_cast<const Real*>(solution->x), x.size(), x.begin());
    cholmod_l_free_dense(&solution, &common);
    factor_->clusters.remove_means(x, 1);
}

} // namespace mpsdem::linear

#else

namespace mpsdem::linear {

struct CholmodReference::Factor {};

CholmodReference::CholmodReference(const LaplacianMatrix&, const Clusters&) {
    throw std::runtime_error(
        "CholmodReference: this build has no CHOLMOD. Install it (Debian: libsuitesparse-dev) and "
        "build again, or use conjugate_gradients, which does not need it");
}

void CholmodReference::solve(std::span<const Real>, std::span<Real>) const {}

} // namespace mpsdem::linear

#endif

namespace mpsdem::linear {

CholmodReference::CholmodReference(CholmodReference&&) noexcept = default;
CholmodReference& CholmodReference::operator=(CholmodReference&&) noexcept = default;
CholmodReference::~CholmodReference() = default;

} // namespace mpsdem::linear
