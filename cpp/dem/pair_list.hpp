#pragma once

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

/// Pairs that may touch before the next sort: those inside the block, then those with a later one;
/// second > first, in each part in ascending order of the first solid.
struct OuterPairs {
    std::vector<Index> first, second; // (pairs,) solids
    std::vector<std::int8_t> image;   // (pairs,) periods to add to x_first - x_second
    std::size_t cross_begin = 0;      // first pair with another block

    void clear() noexcept;
    void append(std::size_t i, std::size_t j, int image_x);
    void append(const OuterPairs& other);
    /// The pairs of [begin, end) whose gap is less than `skin` [m].
    void find_near(const Population& p, Real period, Real skin, std::size_t begin, std::size_t end,
                   std::vector<Index>& near) const;
};

/// Pairs that may touch before the next prune: what the force loop reads. The search for those
/// that do touch reads the short arrays only; a touching pair reads and writes its record. Pairs
/// inside the block come first, then those with a later block; each part fills whole registers.
struct InnerPairs {
    enum Field : std::size_t {
        SPRING = 0,         // [m]   tangential displacement, zero unless the pair touches
        REDUCED_RADIUS = 3, // [m]
        ROLL = 4,           // [rad] rolling displacement, zero unless the pair touches
        REDUCED_MASS = 7,   // [kg]
        record = 8
    };

    std::size_t size = 0;              // slots, padding included
    std::size_t cross_begin = 0;       // first slot of a pair with another block
    std::vector<Index> first, second;  // (slots,) Population::place of the two solids
    std::vector<Index> outer;          // (slots,) pair in OuterPairs, or `padding`
    AlignedVector<Real> shift;         // (slots,) [m] periods to add to x_first - x_second
    AlignedVector<Real> radius_sum;    // (slots,) [m]
    AlignedVector<Real> values;        // (slots * record,)
    std::vector<std::uint8_t> touched; // (slots / lane_count,) bit k: lane k has displacements

    void clear() noexcept;
    void reserve(std::size_t slots);
    void append(const Population& p, std::size_t i, std::size_t j, Real shift_x, Index outer_pair);
    /// Add the pair that stands in another list at `slot`, with its displacements.
    void append(const InnerPairs& from, std::size_t slot);
    void set_history(std::size_t slot, const History& history) noexcept;
    [[nodiscard]] History history(std::size_t slot) const noexcept;
    /// Fill up the register with pairs of solid `self` with itself that can never touch.
    void pad(std::size_t self);
    [[nodiscard]] bool is_padding(std::size_t slot) const noexcept { return radius_sum[slot] == 0; }
};

/// A fixed range of sorted solids with the pairs whose first solid lies in it. Blocks depend on the
/// number of solids alone, and so does the order of every sum: results do not depend on threads.
struct Block {
    std::size_t begin = 0, end = 0; // solids
    OuterPairs outer;
    InnerPairs inner, spare; // `spare` keeps the memory of the list before
    std::vector<Index> near; // room for a prune
    std::vector<std::vector<Index>>
        near_wall;             // by wall: solids that may touch it before next prune
    AlignedVector<Real> cross; // (cross pairs, 8) force and torque / radius [N], as rows, on
                               // another block's solid

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
