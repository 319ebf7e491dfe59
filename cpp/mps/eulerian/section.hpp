#pragma once

#include "core/vec3.hpp"

#include <numbers>
#include <span>
#include <vector>

namespace mpsdem::mps::eulerian {

/// Two nodes on a ring and the shares by which a place between them is interpolated.
struct Between {
    Index node[2];
    Real share[2]; // [-] sum 1
};

/// The nodes of one cross-section of a round pipe, the same at every station: first those inside
/// the bore, then those on its wall.
class Section {
public:
    /// `place` is (y, z) of each node with x = 0; `area` sums to that of the bore.
    Section(std::span<const Vec3> place, std::span<const Real> area, std::size_t wall_count,
            Real pipe_radius, Real spacing);

    [[nodiscard]] std::size_t size() const noexcept { return place_.size(); }
    [[nodiscard]] std::size_t wall_count() const noexcept { return wall_count_; }
    [[nodiscard]] std::size_t interior_count() const noexcept { return size() - wall_count_; }
    [[nodiscard]] const Vec3& place(std::size_t i) const noexcept { return place_[i]; }
    [[nodiscard]] Real area(std::size_t i) const noexcept { return area_[i]; } // [m2]
    [[nodiscard]] Real spacing() const noexcept { return spacing_; }           // [m]
    [[nodiscard]] Real pipe_radius() const noexcept { return pipe_radius_; }   // [m]
    [[nodiscard]] Real wall_distance(std::size_t i) const noexcept {           // [m]
        return pipe_radius_ - norm(place_[i]);
    }
    [[nodiscard]] Vec3 outward(std::size_t i) const noexcept { // [-] from the axis, not on it
        return (1 / norm(place_[i])) * place_[i];
    }
    [[nodiscard]] Real area(std::span<const Index> nodes) const noexcept {
        Real sum = 0;
        for (const Index i : nodes) sum += area_[i];
        return sum;
    }
    [[nodiscard]] Real interior_area() const noexcept { // [m2]
        Real sum = 0;
        for (std::size_t i = 0; i < interior_count(); ++i) sum += area_[i];
        return sum;
    }
    [[nodiscard]] Real bore_area() const noexcept { // [m2]
        Real sum = 0;
        for (const Real a : area_) sum += a;
        return sum;
    }
    [[nodiscard]] Real wall_share() const noexcept { // [m] of the perimeter, of one wall node
        return 2 * std::numbers::pi * pipe_radius_ / static_cast<Real>(wall_count_);
    }

    /// The inner nodes nearest to the wall, and how far they are from it on average [m].
    [[nodiscard]] std::span<const Index> layer() const noexcept { return layer_; }
    [[nodiscard]] Real layer_distance() const noexcept { return layer_distance_; }
    /// Of wall node w (counted from 0): the place of that layer inward of it.
    [[nodiscard]] const Between& inward(std::size_t w) const noexcept { return at_layer_[w]; }
    /// Of layer node l (counted from 0): the place on the wall outward of it.
    [[nodiscard]] const Between& at_wall(std::size_t l) const noexcept { return at_wall_[l]; }

    /// The image of each node where the signs of y and z are those of `sign`; empty where the
    /// pattern is not its own image.
    [[nodiscard]] std::vector<Index> image(const Vec3& sign) const;

private:
    [[nodiscard]] Between between(std::span<const Index> ring, std::size_t i) const;

    std::vector<Vec3> place_; // [m]
    std::vector<Real> area_;  // [m2]
    std::size_t wall_count_;
    Real pipe_radius_, spacing_; // [m]
    std::vector<Index> layer_;
    Real layer_distance_ = 0; // [m]
    std::vector<Between> at_layer_, at_wall_;
};

} // namespace mpsdem::mps::eulerian
