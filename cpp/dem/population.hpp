#pragma once

#include "core/aligned.hpp"
#include "core/lanes.hpp"

#include <utility>
#include <vector>

namespace mpsdem::dem {

/// What surrounds the solids: nothing, a liquid that goes its way, or one that they slow and drive.
enum class Medium { dry, liquid, responding_liquid };

/// The solids in sorted order: solids that are near in space are near in memory.
///
/// A solid is a record of rows of four reals: three components, and one number that travels with
/// them or zero. A row fills a register, so the contact loop reads and adds whole rows. Two rows
/// fill a cache line: a contact writes to the last line only. Spin is stored as the surface speed
/// radius * spin, and torque as the torque over the radius: the contact loop then needs no radius,
/// and both rows of Newton's law share 1 / mass. What contacts never read stands apart, and so does
/// what only a liquid that responds needs.
class Population {
public:
    enum Field : std::size_t {
        X = 0, // [m]     unwrapped since the last sort
        RADIUS = 3,
        VX = 4, // [m/s]
        SX = 8, // [m/s]   radius * spin
        INVERSE_MASS = 11,
        AX = 12, // [m/s2]  acceleration from outside; in a liquid that does not respond,
                 //         drag_rate * liquid velocity is included
        FX = 16, // [N]
        TX = 20, // [N]     torque / radius
        record = 24,
        PX = 24,   // [m]     integral of velocity since forcing was set
        UX = 28,   // [m/s]   liquid velocity
        DRAG = 31, // [1/s]   drag_rate
        X0 = 32,   // [m]     position at the last sort
        rest_end = 36,
        BX = 36,         // [m/s2]  acceleration of the liquid, but for the solids' reaction
        RELAXATION = 39, // [1/s]
        JX = 40,         // [m/s]   what the liquid gave since forcing was set: impulse over mass
        ADDED_MASS = 43, // [-]     over the solid's own
        response_end = 44
    };
    static constexpr std::size_t rest = rest_end - record, response = response_end - rest_end;

    explicit Population(std::size_t count)
        : size_(count), values_(count * record), rest_(count * rest), id_(count), laps_(count) {}

    [[nodiscard]] std::size_t size() const noexcept { return size_; }

    /// Record of solid i in `values`.
    [[nodiscard]] static constexpr std::size_t place(std::size_t i) noexcept { return i * record; }
    [[nodiscard]] static constexpr std::size_t index(std::size_t place) noexcept {
        return place / record;
    }
    [[nodiscard]] Real* values() noexcept { return values_.data(); }
    [[nodiscard]] const Real* values() const noexcept { return values_.data(); }

    [[nodiscard]] Real* at(Field f, std::size_t i) noexcept {
        return const_cast<Real*>(std::as_const(*this).at(f, i));
    }
    [[nodiscard]] const Real* at(Field f, std::size_t i) const noexcept {
        if (f < record) return &values_[i * record + f];
        if (f < rest_end) return &rest_[i * rest + (f - record)];
        return &response_[i * response + (f - rest_end)];
    }
    [[nodiscard]] Vec3 vector(Field f, std::size_t i) const noexcept {
        const Real* v = at(f, i);
        return {v[0], v[1], v[2]};
    }
    void set(Field f, std::size_t i, Vec3 value) noexcept {
        Real* v = at(f, i);
        v[0] = value.x;
        v[1] = value.y;
        v[2] = value.z;
    }

    /// Identity of the solid at a sorted place: its row in the caller's arrays.
    [[nodiscard]] std::vector<Index>& id() noexcept { return id_; }
    [[nodiscard]] const std::vector<Index>& id() const noexcept { return id_; }
    /// Times it went around the periodic axis.
    [[nodiscard]] std::vector<std::int32_t>& laps() noexcept { return laps_; }
    [[nodiscard]] const std::vector<std::int32_t>& laps() const noexcept { return laps_; }

    /// Make room for the fields of a liquid that responds.
    void add_response() { response_.resize(size_ * response); }

    /// visit(values) for every array of reals that is part of the state, in a fixed sequence.
    template <class Visit>
    void for_each_array(const Visit& visit) {
        visit(values_);
        visit(rest_);
    }

    /// Entry k takes what stood at order[k].
    void permute(const std::vector<Index>& order) {
        permute(order, values_, record);
        permute(order, rest_, rest);
        if (!response_.empty()) permute(order, response_, response);
        permute(order, id_, 1);
        permute(order, laps_, 1);
    }

    template <class V>
    static void permute(const std::vector<Index>& order, V& values, std::size_t stride) {
        V sorted(values.size());
        for (std::size_t k = 0; k < order.size(); ++k)
            for (std::size_t f = 0; f < stride; ++f)
                sorted[k * stride + f] = values[order[k] * stride + f];
        values = std::move(sorted);
    }

private:
    std::size_t size_;
    AlignedVector<Real> values_, rest_, response_;
    std::vector<Index> id_;
    std::vector<std::int32_t> laps_;
};

} // namespace mpsdem::dem
