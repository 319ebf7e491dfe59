#pragma once

#include "core/aligned.hpp"
#include "core/vec3.hpp"
#include "dem/population.hpp"

#include <cstdint>
#include <vector>

namespace mpsdem::dem {

/// Tangential and rolling displacement of a touching pair.
struct History {
    Vec3 spring; // [m]
    Vec3 roll;   // [rad]

    friend constexpr History operator-(History h) noexcept { return {-h.spring, -h.roll}; }
    friend constexpr bool operator==(const History&, const History&) noexcept = default;
};

/// Pairs that may touch before the next sort: rows by first solid, second > first.
struct OuterPairs {
    std::vector<Index> row;         // (solids of the block + 1,)
    std::vector<Index> second;      // (pairs,)
    std::vector<std::int8_t> image; // (pairs,) periods to add to x_first - x_second
};

/// Pairs that may touch before the next prune: what the force loop reads, in tiles of `lanes`
/// pairs. Pairs inside the block come first, then those with a later block; each part fills whole
/// tiles.
struct InnerPairs {
    enum Field : std::size_t {
        SHIFT,                // [m]   periods to add to x_first - x_second
        RADIUS_SUM,           // [m]
        REDUCED_RADIUS,       // [m]
        REDUCED_MASS,         // [kg]
        INVERSE_SMALL_RADIUS, // [1/m] of the smaller of the two
        SPRING_X,
        SPRING_Y,
        SPRING_Z,
        ROLL_X,
        ROLL_Y,
        ROLL_Z,
        field_count
    };

    std::size_t size = 0;             // slots, padding included
    std::size_t cross_begin = 0;      // first slot of a pair with another block
    std::vector<Index> first, second; // (slots,) Population::place of the two solids
    std::vector<Index> outer;         // (slots,) pair in OuterPairs, or `padding`
    AlignedVector<Real> values;       // (slots * field_count,) in tiles

    static constexpr Index padding = ~Index{0};

    void clear() noexcept;
    void append(const Population& p, std::size_t i, std::size_t j, Real shift, Index outer_pair,
                const History& history);
    /// Fill up the tile with pairs of solid `self` with itself that can never touch.
    void pad(std::size_t self);

    [[nodiscard]] static constexpr std::size_t place(std::size_t slot) noexcept {
        return slot / lanes * lanes * field_count + slot % lanes;
    }
    [[nodiscard]] Real at(Field f, std::size_t slot) const noexcept {
        return values[place(slot) + f * lanes];
    }
    [[nodiscard]] History history(std::size_t slot) const noexcept;
};

/// A fixed range of sorted solids with the pairs whose first solid lies in it. Blocks depend on the
/// number of solids alone, and so does the order of every sum: results do not depend on threads.
struct Block {
    std::size_t begin = 0, end = 0; // solids, on whole tiles
    OuterPairs outer;
    InnerPairs inner, spare;                 // `spare` keeps the memory of the list before
    std::vector<std::int32_t> slot_of_outer; // inner slot of each outer pair, -1 for none
    AlignedVector<Real> cross; // in tiles: force, torque / radius [N] on another block's solid

    /// Place in `cross` of the note for a cross pair, counted from inner.cross_begin.
    [[nodiscard]] static constexpr std::size_t note_place(std::size_t slot) noexcept {
        return slot / lanes * lanes * 6 + slot % lanes;
    }

    struct Incoming {
        Index block, slot; // counted from that block's cross_begin
    };
    std::vector<Incoming> incoming; // cross pairs of earlier blocks that end here, in order

    Real fastest2 = 0;        // [m2/s2] relative to the list's frame
    Real displacement2 = 0;   // [m2]
    Real largest_overlap = 0; // [-] over the smaller radius
    Vec3 wall_force;          // [N] of the walls on the block's solids, at the current positions
    Vec3 wall_impulse;        // [N s] since the start
};

} // namespace mpsdem::dem
