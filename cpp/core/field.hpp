#pragma once

#include "core/aligned.hpp"
#include "core/lanes.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <type_traits>

namespace mpsdem {

/// Values on nodes x stations, one row a node, periodic along the row: row[-halo, stations + halo)
/// may be read once `wrap` has copied the ends. Field start on a register's border, and an odd
/// number of cache lines lies between them, so that neighboring rows do not fight for cache sets.
class Field {
public:
    static constexpr std::size_t halo = 2;

    Field() = default;
    /// `stations` is a multiple of lane_count.
    Field(std::size_t rows, std::size_t stations)
        : rows_(rows), stations_(stations), stride_(stride_of(stations)),
          values_(rows * stride_ + lane_count, 0) {}

    [[nodiscard]] Real* operator[](std::size_t i) noexcept {
        return values_.data() + i * stride_ + lane_count;
    }
    [[nodiscard]] const Real* operator[](std::size_t i) const noexcept {
        return values_.data() + i * stride_ + lane_count;
    }
    [[nodiscard]] std::size_t rows() const noexcept { return rows_; }
    [[nodiscard]] std::size_t stations() const noexcept { return stations_; }

    /// Copy to the halo what of it lies in the stations [begin, end) of row i.
    void wrap(std::size_t i, std::size_t begin, std::size_t end) noexcept {
        Real* row = (*this)[i];
        if (begin == 0) std::copy_n(row, halo, row + stations_);
        if (end == stations_) std::copy_n(row + stations_ - halo, halo, row - halo);
    }
    void wrap() noexcept {
        for (std::size_t i = 0; i < rows_; ++i) wrap(i, 0, stations_);
    }

private:
    static std::size_t stride_of(std::size_t stations) {
        constexpr std::size_t line = 8; // values
        const std::size_t lines = (stations + lane_count + halo + line - 1) / line;
        return line * (lines | 1);
    }

    std::size_t rows_ = 0, stations_ = 0, stride_ = 0;
    AlignedVector<Real> values_;
};

/// Three components on the same nodes and stations.
struct VectorField {
    Field x, y, z;

    VectorField() = default;
    VectorField(std::size_t rows, std::size_t stations)
        : x(rows, stations), y(rows, stations), z(rows, stations) {}
};

/// Sum and mean in order, so that they do not depend on threads.
[[nodiscard]] inline Real total(std::span<const Real> values) noexcept {
    return std::accumulate(values.begin(), values.end(), Real{0});
}
[[nodiscard]] inline Real mean(std::span<const Real> values) noexcept {
    return total(values) / static_cast<Real>(values.size());
}

/// Cuts the stations into an even number of chunks of whole registers, about 32 stations each: what
/// a sweep reads of one chunk stays in the cache. They do not depend on the number of threads.
class Chunks {
public:
    explicit Chunks(std::size_t stations) : registers_(stations / lane_count) {
        const std::size_t pairs = (stations + 32) / 64;
        count_ = pairs > 0 ? 2 * pairs : stations >= 16 ? 2 : 1;
    }
    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] std::size_t begin(std::size_t chunk) const noexcept {
        return lane_count * (registers_ * chunk / count_);
    }
    [[nodiscard]] std::size_t end(std::size_t chunk) const noexcept { return begin(chunk + 1); }

private:
    std::size_t registers_, count_;
};

/// Run work(station, two or one registers as std::integral_constant) over the stations of a chunk.
template <class Work>
[[gnu::always_inline]] inline void by_registers(std::size_t begin, std::size_t end,
                                                const Work& work) {
    std::size_t k = begin;
    for (; k + 2 * lane_count <= end; k += 2 * lane_count)
        work(k, std::integral_constant<std::size_t, 2>{});
    if (k < end) work(k, std::integral_constant<std::size_t, 1>{});
}

} // namespace mpsdem
