#pragma once

#include "dem/contact_law.hpp"
#include "dem/pair_contact.hpp"
#include "dem/rolling_resistance.hpp"
#include "geometry/surface.hpp"

namespace mpsdem::dem {

/// Displacements of every solid against one wall; zero where they do not touch. Tiles as in the
/// population: spring x, y, z [m], roll x, y, z [rad].
struct WallHistory {
    static constexpr std::size_t field_count = 6;

    AlignedVector<Real> values;       // (solids * 6,) in tiles
    std::vector<std::uint8_t> active; // (registers,) whether any of its solids touched

    [[nodiscard]] static constexpr std::size_t place(std::size_t i) noexcept {
        return i / lanes * lanes * field_count + i % lanes;
    }
    [[nodiscard]] History at(std::size_t i) const noexcept {
        const Real* v = values.data() + place(i);
        return {{v[0], v[lanes], v[2 * lanes]}, {v[3 * lanes], v[4 * lanes], v[5 * lanes]}};
    }
};

/// Contact of solids with a wall, one or a register of them.
template <class T, geometry::Surface S>
[[nodiscard]] Contact<T> wall_contact_of(const S& wall, const Vector<T>& position,
                                         const Vector<T>& velocity, const Vector<T>& surface_speed,
                                         T radius, T inverse_mass) noexcept {
    const geometry::WallPoint<T> at = wall.at(position);
    return {at.normal, velocity - wall.velocity(position) - cross(surface_speed, at.normal),
            radius - at.distance, 1 / (1 / radius + wall.curvature()), 1 / inverse_mass};
}

/// Contact forces of one wall on the solids [first, last), whole tiles of one block, a register of
/// solids at a time; where none touches they are skipped, else those that do not touch are masked.
template <Rolling mode, ContactLaw Law, geometry::Surface S>
[[gnu::flatten]] void wall_contact(const Law& law, const RollingResistance& rolling, const S& wall,
                                   Population& p, Block& block, std::size_t first, std::size_t last,
                                   WallHistory& at_wall, Real dt) noexcept {
    using P = Population;
    const auto load3 = [](const Real* from) {
        return Vector<Lanes>{load(from), load(from + lanes), load(from + 2 * lanes)};
    };
    const auto store3 = [](Real* to, const Vector<Lanes>& v) {
        store(to, v.x);
        store(to + lanes, v.y);
        store(to + 2 * lanes, v.z);
    };
    Lanes most{};
    Vector<Lanes> total{};
    for (std::size_t begin = first; begin < last; begin += lane_count) {
        Real* const solid = p.values() + P::place(begin);
        const Vector<Lanes> position = load3(solid + P::X * lanes);
        Lanes radius = load(solid + P::RADIUS * lanes);
        const LaneMask touching = wall.touches(position, radius);
        std::uint8_t& active = at_wall.active[begin / lane_count];
        const bool contact = any(touching);
        if (!contact && !active) continue;
        active = contact;

        Real* const history = at_wall.values.data() + WallHistory::place(begin);
        // a padding lane has no radius and no mass; any finite numbers serve
        Lanes inverse_mass = load(solid + P::INVERSE_MASS * lanes);
        radius = select(inverse_mass > 0, radius, Lanes{} + 1);
        inverse_mass = select(inverse_mass > 0, inverse_mass, Lanes{} + 1);
        const Vector<Lanes> surface_speed = load3(solid + P::SX * lanes);
        Contact<Lanes> c = wall_contact_of(wall, position, load3(solid + P::VX * lanes),
                                           surface_speed, radius, inverse_mass);
        most = max(most, select(touching, c.overlap / radius, Lanes{}));
        c.overlap = max(c.overlap, least_overlap * radius);
        Vector<Lanes> spring = load3(history);
        const ContactForce<Lanes> force = law.force(c, spring, dt);
        store3(history, masked(touching, spring));
        const Vector<Lanes> on_solid = masked(touching, force.normal * c.normal + force.tangential);
        Vector<Lanes> torque = -cross(c.normal, force.tangential);
        if constexpr (mode == Rolling::resisted) {
            Vector<Lanes> roll = load3(history + 3 * lanes);
            const Lanes inverse = 1 / radius;
            torque += inverse * rolling.torque(c, force, inverse * surface_speed, roll, dt);
            store3(history + 3 * lanes, masked(touching, roll));
        }
        store3(solid + P::FX * lanes, load3(solid + P::FX * lanes) + on_solid);
        store3(solid + P::TX * lanes, load3(solid + P::TX * lanes) + masked(touching, torque));
        total += on_solid;
    }
    block.largest_overlap = std::max(block.largest_overlap, largest(most));
    block.wall_force += Vec3{sum(total.x), sum(total.y), sum(total.z)};
}

} // namespace mpsdem::dem
