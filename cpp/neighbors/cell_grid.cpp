#include "neighbors/cell_grid.hpp"

#include <algorithm>
#include <cmath>

namespace mpsdem::neighbors {

void CellGrid::sort(std::span<const Vec3> position, std::vector<Index>& order) {
    const std::size_t n = position.size();
    std::array<Real, 3> low{}, width{};
    const auto component = [&](std::size_t i, std::size_t d) {
        const Vec3 r = position[i];
        return d == 0 ? r.x : d == 1 ? r.y : r.z;
    };
    for (std::size_t d = 0; d < 3; ++d) {
        Real least = component(0, d), most = least;
        for (std::size_t i = 1; i < n; ++i) {
            least = std::min(least, component(i, d));
            most = std::max(most, component(i, d));
        }
        low[d] = least;
        width[d] = most - least;
    }
    if (period_ > 0) {
        low[0] = 0;
        width[0] = period_;
    }
    // A solid flung far away must not make a grid that fills the memory.
    Real size = cell_size_;
    const Real most_cells = 8. * static_cast<Real>(n) + 4096;
    const auto cells_along = [&](std::size_t d) {
        return std::max(1., std::floor(width[d] / size) + (d == 0 && period_ > 0 ? 0 : 1));
    };
    while (cells_along(0) * cells_along(1) * cells_along(2) > most_cells) size *= 1.26;
    std::array<Real, 3> inverse{};
    for (std::size_t d = 0; d < 3; ++d) {
        n_[d] = static_cast<std::int64_t>(cells_along(d));
        inverse[d] = 1 / size;
    }
    if (period_ > 0) {
        if (n_[0] < 3) n_[0] = 1; // two columns would be each other's neighbor on both sides
        inverse[0] = static_cast<Real>(n_[0]) / period_;
    }

    const auto cells = static_cast<std::size_t>(n_[0] * n_[1] * n_[2]);
    start_.assign(cells + 1, 0);
    std::vector<Index> cell_of(n);
    for (std::size_t i = 0; i < n; ++i) {
        std::int64_t c = 0;
        for (std::size_t d = 0; d < 3; ++d) {
            const auto k = static_cast<std::int64_t>((component(i, d) - low[d]) * inverse[d]);
            c = c * n_[d] + std::clamp<std::int64_t>(k, 0, n_[d] - 1);
        }
        cell_of[i] = static_cast<Index>(c);
        ++start_[static_cast<std::size_t>(c) + 1];
    }
    for (std::size_t c = 0; c < cells; ++c) start_[c + 1] += start_[c];
    order.resize(n);
    cell_.resize(n);
    std::vector<Index> next(start_.begin(), start_.end() - 1);
    for (std::size_t i = 0; i < n; ++i) {
        const Index k = next[cell_of[i]]++;
        order[k] = static_cast<Index>(i);
        cell_[k] = cell_of[i];
    }
}

} // namespace mpsdem::neighbors
