#pragma once

#include "dem/contact_law.hpp"
#include "dem/pair_list.hpp"
#include "dem/rolling_resistance.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace mpsdem::dem {

/// Overlap [-], over a radius, below which the law is not evaluated: it keeps the law finite where
/// rounding leaves no overlap to a pair that just touches.
inline constexpr Real least_overlap = 1e-12;

/// Candidates searched at a time: those that touch are few enough to stay in the nearest cache.
inline constexpr std::size_t batch = 64;

/// Slots by which records are asked for early: in large populations the wait for them, not the
/// arithmetic, sets the pace.
inline constexpr std::size_t look_ahead = 32;

/// Numbers of the candidates that touch, in order. The last register is filled up with repeats.
class Touching {
public:
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] const Index* data() const noexcept { return number_.data(); }
    void clear() noexcept { size_ = 0; }
    /// Add begin + k for every set bit k.
    void add(std::size_t begin, unsigned bits) noexcept {
        for (std::size_t k = 0; k < lane_count; ++k) { // no branch: hits cannot be predicted
            number_[size_] = static_cast<Index>(begin + k);
            size_ += bits >> k & 1u;
        }
    }
    void fill_up() noexcept {
        for (std::size_t k = size_; k % lane_count != 0; ++k) number_[k] = number_[size_ - 1];
    }

private:
    std::array<Index, batch + lane_count> number_;
    std::size_t size_ = 0;
};

/// Find the pairs of slots [begin, end) that touch; those that have parted forget their history.
inline void find_touching(const Population& p, InnerPairs& pairs, std::size_t begin,
                          std::size_t end, Touching& found) noexcept {
    found.clear();
    for (std::size_t slot = begin; slot < end; slot += lane_count) {
        const std::size_t ahead = std::min(slot + look_ahead, pairs.size - lane_count);
        for (std::size_t k = 0; k < lane_count; ++k) {
            const Real* const j = p.values() + pairs.second[ahead + k];
            __builtin_prefetch(j);
            __builtin_prefetch(j + 8);
            __builtin_prefetch(j + 16, 1);
            __builtin_prefetch(&pairs.values[(ahead + k) * InnerPairs::record], 1);
        }
        const auto difference = [&](std::size_t k) {
            return load(p.values() + pairs.first[slot + k] + Population::X) -
                   load(p.values() + pairs.second[slot + k] + Population::X);
        };
        Vector<Lanes> d = turned(difference(0), difference(1), difference(2), difference(3)).v;
        d.x += load(&pairs.shift[slot]);
        const Lanes range = load(&pairs.radius_sum[slot]);
        const unsigned touching = bits(dot(d, d) < range * range);
        std::uint8_t& touched = pairs.touched[slot / lane_count];
        if ((touched & ~touching) != 0)
            for (std::size_t k = 0; k < lane_count; ++k)
                if (((touched & ~touching) >> k & 1u) != 0) pairs.set_history(slot + k, {});
        touched = static_cast<std::uint8_t>(touching);
        found.add(slot, touching);
    }
    found.fill_up();
}

/// Contact forces of the pairs of one block: search a batch of pairs for those that touch, then
/// take these a register at a time.
template <Rolling mode, ContactLaw Law>
[[gnu::flatten]] void pair_contact(const Law& law, const RollingResistance& rolling, Population& p,
                                   Block& block, Real dt) noexcept {
    using P = Population;
    using I = InnerPairs;
    I& pairs = block.inner;
    Real* const solids = p.values();
    Lanes most{};
    Touching found;
    std::fill(block.cross.begin(), block.cross.end(), 0.);
    for (std::size_t begin = 0, end = 0; begin < pairs.size; begin = end) {
        end = std::min(begin + batch, pairs.size);
        find_touching(p, pairs, begin, end, found);
        for (std::size_t h = 0; h < found.size(); h += lane_count) {
            const Index* const slot = found.data() + h;
            Real *i[lane_count], *j[lane_count], *pair[lane_count];
            for (std::size_t k = 0; k < lane_count; ++k) {
                i[k] = solids + pairs.first[slot[k]];
                j[k] = solids + pairs.second[slot[k]];
                pair[k] = pairs.values.data() + slot[k] * I::record;
            }
            const auto rows = [](Real* const* from, std::size_t f) {
                return turned(load(from[0] + f), load(from[1] + f), load(from[2] + f),
                              load(from[3] + f));
            };
            const auto combined = [&](std::size_t f, const auto& combine) {
                const auto row = [&](std::size_t k) {
                    return combine(load(i[k] + f), load(j[k] + f));
                };
                return turned(row(0), row(1), row(2), row(3));
            };
            constexpr auto minus = [](Lanes a, Lanes b) { return a - b; };
            constexpr auto plus = [](Lanes a, Lanes b) { return a + b; };

            auto [d, radius_difference] = combined(P::X, minus);
            d.x += gather(pairs.shift.data(), slot);
            const Lanes radius_sum = gather(pairs.radius_sum.data(), slot);
            const Lanes distance = sqrt(dot(d, d) + std::numeric_limits<Real>::min());
            const Vector<Lanes> normal = (1 / distance) * d;
            auto [spring, reduced_radius] = rows(pair, I::SPRING);
            auto [roll, reduced_mass] = rows(pair, I::ROLL);
            const Lanes overlap = max(radius_sum - distance, least_overlap * reduced_radius);
            const Lanes small_radius = 0.5 * (radius_sum - abs(radius_difference));
            if (bits(overlap > most * small_radius) != 0) // rare: no division for the others
                most = max(most, overlap / small_radius);

            const Contact<Lanes> c{
                normal, combined(P::VX, minus).v - cross(combined(P::SX, plus).v, normal), overlap,
                reduced_radius, reduced_mass};
            const ContactForce<Lanes> force = law.force(c, spring, dt);
            const Vector<Lanes> twist = -cross(normal, force.tangential);
            const Rows on_first = turned(force.normal * normal + force.tangential);
            const Rows new_spring = turned(spring, reduced_radius);
            Rows twist_first = turned(twist), twist_second = twist_first, new_roll;
            if constexpr (mode == Rolling::resisted) {
                const Lanes inverse_i = 1 / rows(i, P::X).w, inverse_j = 1 / rows(j, P::X).w;
                const Vector<Lanes> relative_spin =
                    inverse_i * rows(i, P::SX).v - inverse_j * rows(j, P::SX).v;
                const Vector<Lanes> torque = rolling.torque(c, force, relative_spin, roll, dt);
                twist_first = turned(twist + inverse_i * torque);
                twist_second = turned(twist - inverse_j * torque);
                new_roll = turned(roll, reduced_mass);
            }
            for (std::size_t k = 0; k < std::min(lane_count, found.size() - h); ++k) {
                store(pair[k] + I::SPRING, new_spring.row[k]);
                if constexpr (mode == Rolling::resisted) store(pair[k] + I::ROLL, new_roll.row[k]);
                store(i[k] + P::FX, load(i[k] + P::FX) + on_first.row[k]);
                store(i[k] + P::TX, load(i[k] + P::TX) + twist_first.row[k]);
                if (slot[k] < pairs.cross_begin) {
                    store(j[k] + P::FX, load(j[k] + P::FX) - on_first.row[k]);
                    store(j[k] + P::TX, load(j[k] + P::TX) + twist_second.row[k]);
                } else { // the second solid belongs to another block: leave it a note
                    Real* const note = block.cross.data() + 8 * (slot[k] - pairs.cross_begin);
                    store(note, -on_first.row[k]);
                    store(note + 4, twist_second.row[k]);
                }
            }
        }
    }
    block.largest_overlap = std::max(block.largest_overlap, largest(most));
}

/// Add to a block's solids the forces that earlier blocks found for them, in the order of the
/// lists.
inline void apply_incoming(Population& p, const std::vector<Block>& blocks,
                           const Block& block) noexcept {
    using P = Population;
    for (const auto [source, slot] : block.incoming) {
        const Block& from = blocks[source];
        const Real* const note = from.cross.data() + std::size_t{8} * slot;
        Real* const j = p.values() + from.inner.second[from.inner.cross_begin + slot];
        store(j + P::FX, load(j + P::FX) + load(note));
        store(j + P::TX, load(j + P::TX) + load(note + 4));
    }
}

} // namespace mpsdem::dem
