#pragma once

#include "dem/contact_law.hpp"
#include "dem/pair_contact.hpp"
#include "dem/rolling_resistance.hpp"
#include "geometry/surface.hpp"
#include "geometry/wall.hpp"

namespace mpsdem::dem {

/// Displacements of every solid against one wall, zero where they do not touch: rows of spring [m]
/// and roll [rad], each followed by a zero.
struct WallHistory {
    static constexpr std::size_t record = 8;

    AlignedVector<Real> values; // (solids * record,)

    [[nodiscard]] History at(std::size_t i) const noexcept {
        const Real* v = values.data() + i * record;
        return {{v[0], v[1], v[2]}, {v[4], v[5], v[6]}};
    }
    void clear(std::size_t i) noexcept {
        store(values.data() + i * record, Lanes{});
        store(values.data() + i * record + 4, Lanes{});
    }
};

/// Fastest way [m/s] in which a body of `velocity` can near a wall.
[[nodiscard]] inline Real closing_speed(const geometry::Wall& wall, Vec3 velocity) noexcept {
    if (const auto* plane = std::get_if<geometry::Plane>(&wall))
        return std::abs(dot(velocity, plane->at(Vec3{}).normal));
    if (std::holds_alternative<geometry::BentCylinder>(wall)) return norm(velocity);
    return norm(Vec3{0, velocity.y, velocity.z}); // along the pipe its wall stays as far
}

/// Contact of solids with a wall, one or a register of them.
template <class T, geometry::Surface S>
[[nodiscard]] Contact<T> wall_contact_of(const S& wall, const Vector<T>& position,
                                         const Vector<T>& velocity, const Vector<T>& surface_speed,
                                         T radius, T inverse_mass) noexcept {
    const geometry::WallPoint<T> at = wall.at(position);
    return {at.normal, velocity - wall.velocity(position) - cross(surface_speed, at.normal),
            radius - at.distance, radius / (1 + wall.curvature() * radius), 1 / inverse_mass};
}

/// Contact forces of one wall on those of the solids `near` it that touch it, a register at a time.
template <Rolling mode, ContactLaw Law, geometry::Surface S>
[[gnu::flatten]] void wall_contact(const Law& law, const RollingResistance& rolling, const S& wall,
                                   Population& p, Block& block, std::span<const Index> near,
                                   WallHistory& at_wall, Real dt) noexcept {
    using P = Population;
    const auto rows = [](Real* const* from, std::size_t f) {
        return turned(load(from[0] + f), load(from[1] + f), load(from[2] + f), load(from[3] + f));
    };
    Lanes most{}, total{};
    Touching found;
    for (std::size_t begin = 0, end = 0; begin < near.size(); begin = end) {
        end = std::min(begin + batch, near.size());
        found.clear();
        for (std::size_t n = begin; n < end; n += lane_count) {
            const std::size_t count = std::min(lane_count, end - n);
            Real* solid[lane_count];
            for (std::size_t k = 0; k < lane_count; ++k)
                solid[k] = p.at(P::X, near[n + std::min(k, count - 1)]);
            const auto [position, radius] = rows(solid, P::X);
            const unsigned touching = bits(wall.touches(position, radius)) & ((1u << count) - 1);
            for (std::size_t k = 0; k < count; ++k)
                if ((touching >> k & 1u) == 0) at_wall.clear(near[n + k]);
            found.add(n, touching);
        }
        found.fill_up();
        for (std::size_t h = 0; h < found.size(); h += lane_count) {
            Real *solid[lane_count], *history[lane_count];
            for (std::size_t k = 0; k < lane_count; ++k) {
                const Index i = near[found.data()[h + k]];
                solid[k] = p.at(P::X, i);
                history[k] = at_wall.values.data() + i * WallHistory::record;
            }
            const auto [position, radius] = rows(solid, P::X);
            const auto [surface_speed, inverse_mass] = rows(solid, P::SX);
            Contact<Lanes> c = wall_contact_of(wall, position, rows(solid, P::VX).v, surface_speed,
                                               radius, inverse_mass);
            most = max(most, c.overlap / radius);
            c.overlap = max(c.overlap, least_overlap * radius);
            Vector<Lanes> spring = rows(history, 0).v;
            const ContactForce<Lanes> force = law.force(c, spring, dt);
            Vector<Lanes> torque = -cross(c.normal, force.tangential);
            Rows new_roll;
            if constexpr (mode == Rolling::resisted) {
                Vector<Lanes> roll = rows(history, 4).v;
                const Lanes inverse = 1 / radius;
                torque += inverse * rolling.torque(c, force, inverse * surface_speed, roll, dt);
                new_roll = turned(roll);
            }
            const Rows on_solid = turned(force.normal * c.normal + force.tangential);
            const Rows twist = turned(torque), new_spring = turned(spring);
            for (std::size_t k = 0; k < std::min(lane_count, found.size() - h); ++k) {
                store(history[k], new_spring.row[k]);
                if constexpr (mode == Rolling::resisted) store(history[k] + 4, new_roll.row[k]);
                store(solid[k] + P::FX, load(solid[k] + P::FX) + on_solid.row[k]);
                store(solid[k] + P::TX, load(solid[k] + P::TX) + twist.row[k]);
                total += on_solid.row[k];
            }
        }
    }
    block.largest_overlap = std::max(block.largest_overlap, largest(most));
    block.wall_force += Vec3{total[0], total[1], total[2]};
}

} // namespace mpsdem::dem
