#include "neighbors/cell_grid.hpp"

#include "core/parallel.hpp"

#include <cmath>

namespace mpsdem::neighbors {

Cells::Cells(std::span<const Vec3> position, Real cell_size, Real period, int threads) {
    const std::size_t points = position.size();
    if (points == 0) return;
    constexpr std::size_t blocks = 64;
    std::array<Vec3, blocks> least, most;
    parallel_for(blocks, threads, [&](std::size_t b) {
        Vec3 low_end = position[0], high_end = low_end;
        for (std::size_t i = points * b / blocks; i < points * (b + 1) / blocks; ++i) {
            const Vec3& x = position[i];
            low_end = {std::min(low_end.x, x.x), std::min(low_end.y, x.y),
                       std::min(low_end.z, x.z)};
            high_end = {std::max(high_end.x, x.x), std::max(high_end.y, x.y),
                        std::max(high_end.z, x.z)};
        }
        least[b] = low_end;
        most[b] = high_end;
    });
    std::array<Real, 3> high{most[0].x, most[0].y, most[0].z}, width{};
    low = {least[0].x, least[0].y, least[0].z};
    for (std::size_t b = 1; b < blocks; ++b) {
        low = {std::min(low[0], least[b].x), std::min(low[1], least[b].y),
               std::min(low[2], least[b].z)};
        high = {std::max(high[0], most[b].x), std::max(high[1], most[b].y),
                std::max(high[2], most[b].z)};
    }
    for (std::size_t d = 0; d < 3; ++d) width[d] = high[d] - low[d];
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
