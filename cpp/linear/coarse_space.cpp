#include "linear/coarse_space.hpp"

#include "core/check.hpp"
#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mpsdem::linear {

namespace {

std::array<Real, 3> components(const Vec3& r) noexcept {
    return {r.x, r.y, r.z};
}

bool finite(const Vec3& r) noexcept {
    return std::isfinite(r.x) && std::isfinite(r.y) && std::isfinite(r.z);
}

} // namespace

CoarseSpace::CoarseSpace(std::span<const Vec3> position, Real particle_spacing, Real period)
    : period_(period) {
    require(particle_spacing > 0, "CoarseSpace: particle_spacing must be > 0 m");
    require(period >= 0 && std::isfinite(period), "CoarseSpace: period must be >= 0 m");
    fit_box(position, particle_spacing);
    std::vector<Index> count(box_cells() + 1, 0);
    for (const Vec3& r : position) ++count[box_cell(r)];
    number(merge_sparse(count, particle_spacing));
    assign(position, 1);
}

void CoarseSpace::fit_box(std::span<const Vec3> position, Real particle_spacing) {
    std::array<Real, 3> high{};
    bool empty = true;
    for (const Vec3& r : position) {
        if (!finite(r)) continue;
        const auto x = components(r);
        for (std::size_t d = 0; d < 3; ++d) {
            low_[d] = empty ? x[d] : std::min(low_[d], x[d]);
            high[d] = empty ? x[d] : std::max(high[d], x[d]);
        }
        empty = false;
    }
    // the outermost unknowns stand for half a spacing beyond them
    for (std::size_t d = 0; d < 3; ++d) {
        low_[d] -= particle_spacing / 2;
        high[d] += particle_spacing / 2;
    }
    if (period_ > 0) {
        low_[0] = 0;
        high[0] = period_;
    }
    // An unknown flung far away must not make a box that fills the memory.
    const Real most_cells = 8. * static_cast<Real>(position.size()) + 4096;
    Real target = cell_spacings * particle_spacing;
    const auto along = [&](std::size_t d) {
        return std::max(1., std::round((high[d] - low_[d]) / target));
    };
    while (along(0) * along(1) * along(2) > most_cells) target *= 1.26;
    for (std::size_t d = 0; d < 3; ++d) {
        n_[d] = static_cast<std::size_t>(along(d));
        width_[d] = (high[d] - low_[d]) / along(d);
    }
}

std::size_t CoarseSpace::box_cell(const Vec3& position) const noexcept {
    if (!finite(position)) return box_cells();
    auto x = components(position);
    if (period_ > 0) x[0] -= period_ * std::floor(x[0] / period_);
    std::size_t c = 0;
    for (std::size_t d = 0; d < 3; ++d) {
        const Real last = static_cast<Real>(n_[d] - 1);
        const Real k = std::clamp(std::floor((x[d] - low_[d]) / width_[d]), 0., last);
        c = c * n_[d] + static_cast<std::size_t>(k);
    }
    return c;
}

std::vector<std::size_t> CoarseSpace::merge_sparse(const std::vector<Index>& count,
                                                   Real particle_spacing) const {
    const Real full = width_[0] * width_[1] * width_[2] / std::pow(particle_spacing, 3);
    // Fuller first, then the lower number: a strict order, so that merging runs in no circle.
    const auto fuller = [&](std::size_t a, std::size_t b) {
        return count[a] != count[b] ? count[a] > count[b] : a < b;
    };
    std::vector<std::size_t> target(box_cells(), box_cells()), sparse;
    for (std::size_t c = 0; c < box_cells(); ++c) {
        if (count[c] == 0) continue;
        target[c] = c;
        if (static_cast<Real>(count[c]) < least_fill * full) sparse.push_back(c);
    }
    std::ranges::sort(sparse, fuller);
    for (const std::size_t c : sparse) {
        const std::size_t z = c % n_[2], y = c / n_[2] % n_[1], x = c / n_[2] / n_[1];
        std::size_t best = c;
        for (std::size_t v = y > 0 ? y - 1 : 0; v <= std::min(y + 1, n_[1] - 1); ++v) {
            for (std::size_t w = z > 0 ? z - 1 : 0; w <= std::min(z + 1, n_[2] - 1); ++w) {
                const std::size_t other = (x * n_[1] + v) * n_[2] + w;
                if (fuller(other, best)) best = other;
            }
        }
        target[c] = target[best]; // settled before, as fuller cells come first
    }
    return target;
}

void CoarseSpace::number(const std::vector<std::size_t>& target) {
    number_.assign(box_cells() + 1, 0);
    const std::size_t slab = n_[1] * n_[2];
    for (std::size_t k = 0; k < n_[0]; ++k) {
        const std::size_t x = period_ == 0 ? k : k % 2 == 0 ? k / 2 : n_[0] - 1 - k / 2;
        for (std::size_t c = x * slab; c < (x + 1) * slab; ++c) {
            if (target[c] == c) number_[c] = static_cast<Index>(size_++);
        }
    }
    number_.back() = static_cast<Index>(size_);
    for (std::size_t c = 0; c < box_cells(); ++c) {
        number_[c] = number_[target[c]];
    }
}

void CoarseSpace::assign(std::span<const Vec3> position, int threads) {
    cell_.resize(position.size());
    parallel_for(position.size(), threads,
                 [&](std::size_t i) { cell_[i] = number_[box_cell(position[i])]; });
    start_.assign(size_ + 2, 0);
    for (const Index c : cell_) ++start_[c + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    member_.resize(position.size());
    std::vector<Index> next(start_.begin(), start_.end() - 1);
    for (std::size_t i = 0; i < position.size(); ++i) {
        member_[next[cell_[i]]++] = static_cast<Index>(i);
    }
}

} // namespace mpsdem::linear
