#pragma once

#include "dem/lubrication.hpp"
#include "dem/wall_contact.hpp"

namespace mpsdem::dem {

/// Lubrication between the pairs of one block, whose list holds all gaps up to `reach` [m]. Comes
/// after pair_contact, which clears the notes for other blocks.
[[gnu::flatten]] inline void lubricate_pairs(const Lubrication& lubrication, Real reach,
                                             Population& p, Block& block) noexcept {
    using P = Population;
    using I = InnerPairs;
    const I& pairs = block.inner;
    Real* const solids = p.values();
    Touching found;
    for (std::size_t begin = 0, end = 0; begin < pairs.size; begin = end) {
        end = std::min(begin + batch, pairs.size);
        found.clear();
        for (std::size_t slot = begin; slot < end; slot += lane_count) {
            const auto difference = [&](std::size_t k) {
                return load(solids + pairs.first[slot + k] + P::X) -
                       load(solids + pairs.second[slot + k] + P::X);
            };
            Vector<Lanes> d = turned(difference(0), difference(1), difference(2), difference(3)).v;
            d.x += load(&pairs.shift[slot]);
            const Lanes radius_sum = load(&pairs.radius_sum[slot]), range = radius_sum + reach;
            const Lanes distance2 = dot(d, d);
            found.add(slot, bits(distance2 < range * range) & // padding has no radius
                                bits(distance2 > radius_sum * radius_sum) & bits(radius_sum > 0));
        }
        found.fill_up();
        for (std::size_t h = 0; h < found.size(); h += lane_count) {
            const Index* const slot = found.data() + h;
            Real *i[lane_count], *j[lane_count];
            Lanes reduced_radius{};
            for (std::size_t k = 0; k < lane_count; ++k) {
                i[k] = solids + pairs.first[slot[k]];
                j[k] = solids + pairs.second[slot[k]];
                reduced_radius[k] = pairs.values[slot[k] * I::record + I::REDUCED_RADIUS];
            }
            const auto difference = [&](std::size_t f) {
                const auto row = [&](std::size_t k) { return load(i[k] + f) - load(j[k] + f); };
                return turned(row(0), row(1), row(2), row(3)).v;
            };
            Vector<Lanes> d = difference(P::X);
            d.x += gather(pairs.shift.data(), slot);
            const Lanes distance = norm(d);
            const Vector<Lanes> normal = (1 / distance) * d;
            const Lanes gap = distance - gather(pairs.radius_sum.data(), slot);
            const Lanes force =
                lubrication.force(gap, dot(difference(P::VX), normal), reduced_radius);
            const Rows on_first = turned(force * normal);
            for (std::size_t k = 0; k < std::min(lane_count, found.size() - h); ++k) {
                store(i[k] + P::FX, load(i[k] + P::FX) + on_first.row[k]);
                Real* const second = slot[k] < pairs.cross_begin
                                         ? j[k] + P::FX
                                         : block.cross.data() + 8 * (slot[k] - pairs.cross_begin);
                store(second, load(second) - on_first.row[k]);
            }
        }
    }
}

/// Lubrication of one wall on those of the solids `near` it whose gap is at most `reach` [m].
template <geometry::Surface S>
[[gnu::flatten]] void lubricate_wall(const Lubrication& lubrication, Real reach, const S& wall,
                                     Population& p, Block& block,
                                     std::span<const Index> near) noexcept {
    using P = Population;
    Vec3 total;
    for (const Index i : near) {
        const Real radius = *p.at(P::RADIUS, i);
        const Vec3 position = p.vector(P::X, i);
        if (!wall.touches(position, radius + reach)) continue;
        const Contact<Real> c =
            wall_contact_of(wall, position, p.vector(P::VX, i), p.vector(P::SX, i), radius,
                            *p.at(P::INVERSE_MASS, i));
        const Vec3 force =
            lubrication.force(-c.overlap, dot(c.relative_velocity, c.normal), c.reduced_radius) *
            c.normal;
        p.set(P::FX, i, p.vector(P::FX, i) + force);
        total += force;
    }
    block.wall_force += total;
}

} // namespace mpsdem::dem
