#pragma once

#include "core/vec3.hpp"

#include <array>
#include <span>
#include <vector>

namespace mpsdem::linear {

/// Of a set of nodes with two mirrors, the image of each in either; none at all: both empty.
struct Mirrors {
    std::span<const Index> first, second;
};

/// Values on nodes, taken apart into those even and odd in each of two mirrors: four classes which
/// an operator that shares the mirrors does not mix, so that it falls into four blocks, each with
/// about a quarter of the nodes. In place of the values of a node and its images stand their sums
/// and differences, scaled so that the transform is its own inverse and orthonormal.
///
/// Rows are ordered by class, in each the interior's before the wall's.
class ParityClasses {
public:
    /// Rows of one class: [begin, begin + interior) and the wall's after them.
    struct Class {
        std::size_t begin = 0, interior = 0, wall = 0;
        [[nodiscard]] std::size_t size() const noexcept { return interior + wall; }
    };

    /// Interior nodes come first. Without mirrors, one class has them all.
    ParityClasses(std::size_t interior_count, std::size_t wall_count, const Mirrors& mirrors);

    /// Where node i's values stand.
    [[nodiscard]] std::span<const Index> row() const noexcept { return row_; }
    [[nodiscard]] std::span<const Class> classes() const noexcept { return classes_; }

    /// From nodes to classes and back, of `count` values from `first` on in each row of `stride`.
    void transform(Real* values, std::size_t stride, std::size_t first, std::size_t count) const;

private:
    std::vector<Index> row_;
    std::vector<Class> classes_;
    std::vector<std::array<Index, 2>> pairs_; // rows of a node on a mirror and of its image
    std::vector<std::array<Index, 4>> fours_; // rows of a node off both and of its images
};

} // namespace mpsdem::linear
