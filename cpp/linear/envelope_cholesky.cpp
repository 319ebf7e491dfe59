#include "linear/envelope_cholesky.hpp"

#include "linear/float_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace mpsdem::linear {

namespace {

constexpr Real vanished = 1e-9; // [-] of the diagonal: a pivot that is round-off

/// sum_k a(k) line[k]: one entry of L for each row of a group.
template <class Entry>
Lanes combine(const Entry& a, const Lanes* line, std::size_t from, std::size_t to) noexcept {
    Lanes even{}, odd{};
    std::size_t k = from;
    for (; k + 2 <= to; k += 2) {
        even += a(k) * line[k];
        odd += a(k + 1) * line[k + 1];
    }
    if (k < to) even += a(k) * line[k];
    return even + odd;
}

} // namespace

EnvelopeCholesky::EnvelopeCholesky(const SparseRows<Real>& matrix)
    : first_(matrix.size()), start_(matrix.size() + 1, 0), inverse_(matrix.size()) {
    for (std::size_t i = 0; i < size(); ++i) {
        first_[i] = static_cast<Index>(i);
        for (std::size_t k = matrix.start[i]; k < matrix.start[i + 1]; ++k) {
            first_[i] = std::min(first_[i], matrix.column[k]);
        }
        start_[i + 1] = start_[i] + (i - first_[i]);
    }
    value_.resize(start_.back());

    std::vector<Lanes> line(size());
    for (std::size_t group = 0; group < size(); group += lane_count) {
        factor_group(matrix, group, std::min(group + lane_count, size()), line);
    }
}

void EnvelopeCholesky::factor_group(const SparseRows<Real>& matrix, std::size_t begin,
                                    std::size_t end, std::span<Lanes> line) {
    std::size_t from = begin;
    for (std::size_t i = begin; i < end; ++i) from = std::min<std::size_t>(from, first_[i]);
    std::ranges::fill(line.subspan(from, end - from), Lanes{});
    std::array<Real, lane_count> diagonal{};
    for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t k = matrix.start[i]; k < matrix.start[i + 1]; ++k) {
            if (matrix.column[k] <= i) line[matrix.column[k]][i - begin] = matrix.value[k];
        }
        diagonal[i - begin] = line[i][i - begin];
    }

    for (std::size_t j = from; j < begin; ++j) {
        const auto entry = [&, shift = start_[j] - first_[j]](std::size_t k) {
            return static_cast<Real>(value_[shift + k]);
        };
        line[j] -= combine(entry, line.data(), std::max<std::size_t>(from, first_[j]), j);
        line[j] *= inverse_[j];
    }
    for (std::size_t j = begin; j < end; ++j) {
        const std::size_t lane = j - begin;
        const auto entry = [&](std::size_t k) { return static_cast<Real>(line[k][lane]); };
        line[j] -= combine(entry, line.data(), from, j);
        Real pivot = line[j][lane];
        if (pivot <= vanished * diagonal[lane]) pivot = diagonal[lane] > 0 ? diagonal[lane] : 1;
        inverse_[j] = 1 / std::sqrt(pivot);
        line[j] *= inverse_[j];
    }
    for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t k = first_[i]; k < i; ++k) {
            value_[start_[i] + (k - first_[i])] = static_cast<float>(line[k][i - begin]);
        }
    }
}

void EnvelopeCholesky::solve(std::span<Real> y) const noexcept {
    for (std::size_t i = 0; i < size(); ++i) {
        const Real before = row_dot(value_.data() + start_[i], &y[first_[i]], i - first_[i]);
        y[i] = (y[i] - before) * inverse_[i];
    }
    for (std::size_t i = size(); i-- > 0;) {
        y[i] *= inverse_[i];
        const float* l = value_.data() + start_[i];
        for (std::size_t j = first_[i]; j < i; ++j) y[j] -= static_cast<Real>(*l++) * y[i];
    }
}

} // namespace mpsdem::linear
