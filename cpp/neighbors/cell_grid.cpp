#include "neighbors/cell_grid.hpp"

#include "core/parallel.hpp"

#include <cmath>

namespace mpsdem::neighbors {

Cells::Cells(std::span<const Vec3> position, Real cell_size, Real period) {
    const std::size_t points = position.size();
    if (points == 0) return;
    const auto component = [&](std::size_t i, std::size_t d) {
        const Vec3 r = position[i];
        return d == 0 ? r.x : d == 1 ? r.y : r.z;
    };
    std::array<Real, 3> width{};
    for (std::size_t d = 0; d < 3; ++d) {
        Real least = component(0, d), most = least;
        for (std::size_t i = 1; i < points; ++i) {
            least = std::min(least, component(i, d));
            most = std::max(most, component(i, d));
        }
        low[d] = least;
        width[d] = most - least;
    }
    if (period > 0) {
        low[0] = 0;
        width[0] = period;
    }
    // A solid flung far away must not make a grid that fills the memory.
    Real size = cell_size;
    const Real most_cells = 8. * static_cast<Real>(points) + 4096;
    const auto cells_along = [&](std::size_t d) {
        return std::max(1., std::floor(width[d] / size) + (d == 0 && period > 0 ? 0 : 1));
    };
    while (cells_along(0) * cells_along(1) * cells_along(2) > most_cells) size *= 1.26;
    for (std::size_t d = 0; d < 3; ++d) {
        n[d] = static_cast<std::int64_t>(cells_along(d));
        inverse[d] = 1 / size;
    }
    if (period > 0) {
        if (n[0] < 3) n[0] = 1; // two columns would be each other's neighbor on both sides
        inverse[0] = static_cast<Real>(n[0]) / period;
    }
}

void CellGrid::sort(std::span<const Vec3> position, const Cells& cells, std::vector<Index>& order,
                    int threads) {
    const std::size_t count = position.size();
    n_ = cells.n;
    start_.clear();
    cell_.resize(count);
    order.resize(count);
    if (count == 0) return;
    cell_of_.resize(count);
    parallel_for(count, threads, [&](std::size_t i) { cell_of_[i] = cells.of(position[i]); });
    start_.assign(cells.count() + 1, 0);
    for (const Index c : cell_of_) ++start_[c + 1];
    for (std::size_t c = 0; c < cells.count(); ++c) start_[c + 1] += start_[c];
    next_.assign(start_.begin(), start_.end() - 1);
    for (std::size_t i = 0; i < count; ++i) {
        const Index k = next_[cell_of_[i]]++;
        order[k] = static_cast<Index>(i);
        cell_[k] = cell_of_[i];
    }
}

} // namespace mpsdem::neighbors
