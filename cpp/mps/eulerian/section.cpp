#include "mps/eulerian/section.hpp"

#include "core/check.hpp"

#include <algorithm>
#include <cmath>

namespace mpsdem::mps::eulerian {

namespace {

Real angle(const Vec3& a) {
    return std::atan2(a.z, a.y);
}

} // namespace

Section::Section(std::span<const Vec3> place, std::span<const Real> area, std::size_t wall_count,
                 Real pipe_radius, Real spacing)
    : place_(place.begin(), place.end()), area_(area.begin(), area.end()), wall_count_(wall_count),
      pipe_radius_(pipe_radius), spacing_(spacing) {
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
    require(layer_.size() >= 6, "Section: a layer of nodes one spacing from the wall is needed");
    for (const Index i : layer_) layer_distance_ += wall_distance(i);
    layer_distance_ /= static_cast<Real>(layer_.size());
    std::vector<Index> wall;
    for (std::size_t i = interior_count(); i < size(); ++i) wall.push_back(static_cast<Index>(i));
    for (const Index i : wall) at_layer_.push_back(between(layer_, i));
    for (const Index i : layer_) at_wall_.push_back(between(wall, i));
}

/// Neighbors of node i in angle among `ring`.
Between Section::between(std::span<const Index> ring, std::size_t i) const {
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

std::vector<Index> Section::image(const Vec3& sign) const {
    std::vector<Index> of_node;
    for (const Vec3& x : place_) {
        const Vec3 mirrored{0, sign.y * x.y, sign.z * x.z};
        const auto same = std::ranges::find_if(
            place_, [&](const Vec3& other) { return norm(other - mirrored) < 1e-9 * spacing_; });
        if (same == place_.end()) return {};
        of_node.push_back(static_cast<Index>(same - place_.begin()));
    }
    return of_node;
}

} // namespace mpsdem::mps::eulerian
