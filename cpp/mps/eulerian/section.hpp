#pragma once

#include "core/check.hpp"
#include "core/vec3.hpp"

#include <algorithm>
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
            Real pipe_radius, Real spacing)
        : place_(place.begin(), place.end()), area_(area.begin(), area.end()),
          wall_count_(wall_count), pipe_radius_(pipe_radius), spacing_(spacing) {
        require(pipe_radius > 0, "Section: pipe_radius must be > 0 m");
        require(spacing > 0, "Section: spacing must be > 0 m");
        require(area.size() == place.size(), "Section: area must have one value per node");
        require(wall_count >= 6 && 2 * wall_count < place.size() + wall_count,
                "Section: at least 6 nodes on the wall, and as many inside, are needed");
        for (std::size_t i = interior_count(); i < size(); ++i) {
            require(std::abs(wall_distance(i)) < 1e-6 * spacing,
                    "Section: the last wall_count nodes must lie on the wall");
        }
        for (std::size_t i = 0; i < interior_count(); ++i) {
            require(wall_distance(i) > 0.5 * spacing,
                    "Section: inner nodes must be half a spacing from the wall and more");
            if (wall_distance(i) < 1.5 * spacing) layer_.push_back(static_cast<Index>(i));
        }
        require(layer_.size() >= 6,
                "Section: a layer of nodes one spacing from the wall is needed");
        for (const Index i : layer_) layer_distance_ += wall_distance(i);
        layer_distance_ /= static_cast<Real>(layer_.size());
        std::vector<Index> wall;
        for (std::size_t i = interior_count(); i < size(); ++i)
            wall.push_back(static_cast<Index>(i));
        for (const Index i : wall) at_layer_.push_back(between(layer_, i));
        for (const Index i : layer_) at_wall_.push_back(between(wall, i));
    }

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

private:
    [[nodiscard]] static Real angle(const Vec3& a) noexcept { return std::atan2(a.z, a.y); }

    /// Neighbors of node i in angle among `ring`.
    [[nodiscard]] Between between(std::span<const Index> ring, std::size_t i) const {
        constexpr Real turn = 2 * std::numbers::pi;
        Real before = turn, after = turn; // [rad]
        Between b{};
        for (const Index j : ring) {
            const Real difference = angle(place_[j]) - angle(place_[i]);
            const Real ahead = difference - turn * std::floor(difference / turn);
            if (ahead < after) {
                after = ahead;
                b.node[1] = j;
            }
            const Real behind = ahead > 0 ? turn - ahead : 0;
            if (behind < before) {
                before = behind;
                b.node[0] = j;
            }
        }
        b.share[1] = before + after > 0 ? before / (before + after) : 0;
        b.share[0] = 1 - b.share[1];
        return b;
    }

    std::vector<Vec3> place_; // [m]
    std::vector<Real> area_;  // [m2]
    std::size_t wall_count_;
    Real pipe_radius_, spacing_; // [m]
    std::vector<Index> layer_;
    Real layer_distance_ = 0; // [m]
    std::vector<Between> at_layer_, at_wall_;
};

} // namespace mpsdem::mps::eulerian
