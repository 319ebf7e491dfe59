#pragma once

#include "core/aligned.hpp"
#include "core/vec3.hpp"

#include <vector>

namespace mpsdem::dem {

/// What surrounds the solids; only a liquid drags them.
enum class Medium { dry, liquid };

/// Lanes that the loops over solids take at a time; every array is padded to a multiple of it.
inline constexpr std::size_t lanes = 8;

/// The solids in sorted order: solids that are near in space are near in memory.
///
/// Fields stand in tiles of `lanes` solids: a tile's values of one field are side by side for
/// vector loops over solids, and all fields of one solid lie at fixed distances from one address
/// for gathers. Spin is stored as the surface speed radius * spin, and torque as the torque over
/// the radius: the contact loop then needs no radius, and both rows of Newton's law share 1 / mass.
class Population {
public:
    enum Field : std::size_t {
        X,
        Y,
        Z, // [m]     unwrapped since the last sort
        VX,
        VY,
        VZ, // [m/s]
        SX,
        SY,
        SZ, // [m/s]   radius * spin
        FX,
        FY,
        FZ, // [N]
        TX,
        TY,
        TZ, // [N]     torque / radius
        AX,
        AY,
        AZ, // [m/s2]  acceleration from outside, drag_rate * liquid velocity included
        INVERSE_MASS,
        RADIUS,
        DRAG, // [1/s]   drag_rate
        UX,
        UY,
        UZ, // [m/s]   liquid velocity
        PX,
        PY,
        PZ, // [m]     integral of velocity since forcing was set
        X0,
        Y0,
        Z0, // [m]     position at the last sort
        field_count
    };
    static constexpr std::size_t tile = field_count * lanes; // values of one tile

    explicit Population(std::size_t count)
        : size_(count), padded_((count + lanes - 1) / lanes * lanes),
          values_(padded_ * field_count), id_(count), laps_(count) {
        for (std::size_t i = count; i < padded_; ++i)
            at(RADIUS, i) = -1e300; // a padding entry is out of reach of every wall and list
    }

    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] std::size_t padded() const noexcept { return padded_; }

    /// Place of solid i in `values`; field f stands f * lanes further.
    [[nodiscard]] static constexpr std::size_t place(std::size_t i) noexcept {
        return i / lanes * tile + i % lanes;
    }
    [[nodiscard]] static constexpr std::size_t index(std::size_t place) noexcept {
        return place / tile * lanes + place % lanes;
    }
    [[nodiscard]] Real* values() noexcept { return values_.data(); }
    [[nodiscard]] const Real* values() const noexcept { return values_.data(); }

    [[nodiscard]] Real& at(Field f, std::size_t i) noexcept {
        return values_[place(i) + f * lanes];
    }
    [[nodiscard]] Real at(Field f, std::size_t i) const noexcept {
        return values_[place(i) + f * lanes];
    }
    [[nodiscard]] Vec3 vector(Field first, std::size_t i) const noexcept {
        const Real* v = values() + place(i) + first * lanes;
        return {v[0], v[lanes], v[2 * lanes]};
    }
    void set(Field first, std::size_t i, Vec3 value) noexcept {
        Real* v = values() + place(i) + first * lanes;
        v[0] = value.x;
        v[lanes] = value.y;
        v[2 * lanes] = value.z;
    }
    void add(Field first, std::size_t i, Vec3 value) noexcept {
        set(first, i, vector(first, i) + value);
    }

    /// Identity of the solid at a sorted place: its row in the caller's arrays.
    [[nodiscard]] std::vector<Index>& id() noexcept { return id_; }
    [[nodiscard]] const std::vector<Index>& id() const noexcept { return id_; }
    /// Times it went around the periodic axis.
    [[nodiscard]] std::vector<std::int32_t>& laps() noexcept { return laps_; }
    [[nodiscard]] const std::vector<std::int32_t>& laps() const noexcept { return laps_; }

    /// Entry k takes what stood at order[k].
    void permute(const std::vector<Index>& order) {
        AlignedVector<Real> sorted = values_; // keeps the padding
        for (std::size_t k = 0; k < size_; ++k)
            for (std::size_t f = 0; f < field_count; ++f)
                sorted[place(k) + f * lanes] = values_[place(order[k]) + f * lanes];
        values_ = std::move(sorted);
        std::vector<Index> id(size_);
        std::vector<std::int32_t> laps(size_);
        for (std::size_t k = 0; k < size_; ++k) {
            id[k] = id_[order[k]];
            laps[k] = laps_[order[k]];
        }
        id_ = std::move(id);
        laps_ = std::move(laps);
    }

private:
    std::size_t size_, padded_;
    AlignedVector<Real> values_;
    std::vector<Index> id_;
    std::vector<std::int32_t> laps_;
};

} // namespace mpsdem::dem
