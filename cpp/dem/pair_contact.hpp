#pragma once

#include "dem/contact_law.hpp"
#include "dem/pair_list.hpp"
#include "dem/rolling_resistance.hpp"

#include <limits>

namespace mpsdem::dem {

/// Overlap [-], over a radius, at which the law is evaluated in lanes that do not touch: it keeps
/// them finite, and their result is masked.
inline constexpr Real least_overlap = 1e-12;

/// Contact forces of the pairs of one block, a register of pairs at a time. Pairs that do not touch
/// are carried as masked lanes: the inner list holds few of them.
template <Rolling mode, ContactLaw Law>
[[gnu::flatten]] void pair_contact(const Law& law, const RollingResistance& rolling, Population& p,
                                   Block& block, Real dt) noexcept {
    using P = Population;
    using I = InnerPairs;
    constexpr std::size_t width = mode == Rolling::resisted ? 9 : 6;
    I& pairs = block.inner;
    Real* const solids = p.values();
    const auto gather3 = [solids](const Index* place, P::Field f) {
        const Real* v = solids + f * lanes;
        return Vector<Lanes>{gather(v, place), gather(v + lanes, place),
                             gather(v + 2 * lanes, place)};
    };
    const auto store3 = [](Real* to, std::size_t stride, const Vector<Lanes>& v) {
        store(to, v.x);
        store(to + stride, v.y);
        store(to + 2 * stride, v.z);
    };
    const auto load3 = [](const Real* from) {
        return Vector<Lanes>{load(from), load(from + lanes), load(from + 2 * lanes)};
    };

    Lanes most{};
    // force, torque / radius on first, torque / radius on second
    alignas(64) Real out[width * lane_count];
    for (std::size_t slot = 0; slot < pairs.size; slot += lane_count) {
        const Index* first = pairs.first.data() + slot;
        const Index* second = pairs.second.data() + slot;
        Real* const row = pairs.values.data() + I::place(slot);

        Vector<Lanes> d = gather3(first, P::X) - gather3(second, P::X);
        d.x += load(row + I::SHIFT * lanes);
        const Lanes distance = sqrt(dot(d, d) + std::numeric_limits<Real>::min());
        const Vector<Lanes> normal = (1 / distance) * d;
        const Lanes overlap = load(row + I::RADIUS_SUM * lanes) - distance;
        const LaneMask touching = overlap > 0;
        most = max(most, overlap * load(row + I::INVERSE_SMALL_RADIUS * lanes));

        const Vector<Lanes> s_i = gather3(first, P::SX), s_j = gather3(second, P::SX);
        const Vector<Lanes> v_ij = gather3(first, P::VX) - gather3(second, P::VX);
        const Lanes reduced_radius = load(row + I::REDUCED_RADIUS * lanes);
        const Contact<Lanes> c{normal, v_ij - cross(s_i + s_j, normal),
                               max(overlap, least_overlap * reduced_radius), reduced_radius,
                               load(row + I::REDUCED_MASS * lanes)};
        Vector<Lanes> spring = load3(row + I::SPRING_X * lanes);
        const ContactForce<Lanes> force = law.force(c, spring, dt);
        store3(row + I::SPRING_X * lanes, lanes, masked(touching, spring));
        store3(out, lane_count, masked(touching, force.normal * normal + force.tangential));
        const Vector<Lanes> twist = -cross(normal, force.tangential);
        if constexpr (mode == Rolling::free) {
            store3(out + 3 * lane_count, lane_count, masked(touching, twist));
        } else {
            const Lanes inverse_i = 1 / gather(solids + P::RADIUS * lanes, first);
            const Lanes inverse_j = 1 / gather(solids + P::RADIUS * lanes, second);
            Vector<Lanes> roll = load3(row + I::ROLL_X * lanes);
            const Vector<Lanes> torque =
                rolling.torque(c, force, inverse_i * s_i - inverse_j * s_j, roll, dt);
            store3(row + I::ROLL_X * lanes, lanes, masked(touching, roll));
            store3(out + 3 * lane_count, lane_count, masked(touching, twist + inverse_i * torque));
            store3(out + 6 * lane_count, lane_count, masked(touching, twist - inverse_j * torque));
        }

        if (slot < pairs.cross_begin) {
            for (std::size_t k = 0; k < lane_count; ++k) {
                Real* i = solids + first[k] + P::FX * lanes;
                Real* j = solids + second[k] + P::FX * lanes;
                for (std::size_t f = 0; f < 6; ++f) i[f * lanes] += out[f * lane_count + k];
                for (std::size_t f = 0; f < 3; ++f) j[f * lanes] -= out[f * lane_count + k];
                for (std::size_t f = 3; f < 6; ++f)
                    j[f * lanes] += out[(f + width - 6) * lane_count + k];
            }
        } else { // the second solid belongs to another block: leave it a note
            Real* note = block.cross.data() + Block::note_place(slot - pairs.cross_begin);
            for (std::size_t k = 0; k < lane_count; ++k) {
                Real* i = solids + first[k] + P::FX * lanes;
                for (std::size_t f = 0; f < 6; ++f) i[f * lanes] += out[f * lane_count + k];
                for (std::size_t f = 0; f < 3; ++f) note[f * lanes + k] = -out[f * lane_count + k];
                for (std::size_t f = 3; f < 6; ++f)
                    note[f * lanes + k] = out[(f + width - 6) * lane_count + k];
            }
        }
    }
    block.largest_overlap = std::max(block.largest_overlap, largest(most));
}

/// Add to a block's solids the forces that earlier blocks found for them, in the order of the
/// lists.
inline void apply_incoming(Population& p, const std::vector<Block>& blocks,
                           const Block& block) noexcept {
    for (const auto [source, slot] : block.incoming) {
        const Block& from = blocks[source];
        const Real* note = from.cross.data() + Block::note_place(slot);
        Real* j =
            p.values() + from.inner.second[from.inner.cross_begin + slot] + Population::FX * lanes;
        for (std::size_t f = 0; f < 6; ++f) j[f * lanes] += note[f * lanes];
    }
}

} // namespace mpsdem::dem
