#include "linear/mirrors.hpp"

#include "core/check.hpp"

#include <algorithm>
#include <numbers>

namespace mpsdem::linear {

namespace {

constexpr std::size_t class_count = 4; // even and odd in the first mirror, in the second

/// Nodes that the mirrors carry into each other, and the class in which each one's row stands: all
/// even first; none of an odd one where a mirror leaves the nodes where they are.
struct Orbit {
    std::array<Index, class_count> node;
    std::array<std::size_t, class_count> parity;
    std::size_t count;
};

std::vector<Orbit> orbits_of(std::size_t size, const Mirrors& mirrors) {
    std::vector<Orbit> orbits;
    for (std::size_t n = 0; n < size; ++n) {
        const auto i = static_cast<Index>(n);
        if (mirrors.first.empty()) {
            orbits.push_back({{i}, {0}, 1});
            continue;
        }
        const Index a = mirrors.first[i], b = mirrors.second[i];
        require(a < size && b < size && mirrors.first[a] == i && mirrors.second[b] == i &&
                    mirrors.first[b] == mirrors.second[a],
                "mirrors: each must be its own inverse, and their order must not matter");
        const Index c = mirrors.first[b];
        if (i != std::min({i, a, b, c})) continue;
        if (i == a && i == b)
            orbits.push_back({{i}, {0}, 1});
        else if (i == a)
            orbits.push_back({{i, b}, {0, 2}, 2});
        else if (i == b)
            orbits.push_back({{i, a}, {0, 1}, 2});
        else if (i == c)
            orbits.push_back({{i, a}, {0, 3}, 2});
        else
            orbits.push_back({{i, a, b, c}, {0, 1, 2, 3}, 4});
    }
    return orbits;
}

} // namespace

ParityClasses::ParityClasses(std::size_t interior_count, std::size_t wall_count,
                             const Mirrors& mirrors)
    : row_(interior_count + wall_count) {
    const std::size_t size = row_.size();
    require(mirrors.first.size() == mirrors.second.size() &&
                (mirrors.first.empty() || mirrors.first.size() == size),
            "mirrors: each must have one image per node");
    const std::vector<Orbit> orbits = orbits_of(size, mirrors);
    std::size_t next = 0;
    for (std::size_t parity = 0; parity < class_count; ++parity) {
        Class rows{next};
        const auto take = [&](bool interior, std::size_t& count) {
            for (const Orbit& orbit : orbits) {
                for (std::size_t m = 0; m < orbit.count; ++m) {
                    if (orbit.parity[m] != parity || (orbit.node[m] < interior_count) != interior)
                        continue;
                    row_[orbit.node[m]] = static_cast<Index>(next++);
                    ++count;
                }
            }
        };
        take(true, rows.interior);
        take(false, rows.wall);
        if (rows.size() > 0) classes_.push_back(rows);
    }
    for (const Orbit& orbit : orbits) {
        const auto row = [&](std::size_t m) { return row_[orbit.node[m]]; };
        for (std::size_t m = 0; m < orbit.count; ++m) {
            require((orbit.node[m] < interior_count) == (orbit.node[0] < interior_count),
                    "mirrors: the image of an interior node must be one");
        }
        if (orbit.count == 2) pairs_.push_back({row(0), row(1)});
        if (orbit.count == 4) fours_.push_back({row(0), row(1), row(2), row(3)});
    }
}

void ParityClasses::transform(Real* values, std::size_t stride, std::size_t first,
                              std::size_t count) const {
    const auto row = [&](Index i) { return values + i * stride + first; };
    constexpr Real half = std::numbers::sqrt2 / 2;
    for (const auto& pair : pairs_) {
        Real *a = row(pair[0]), *b = row(pair[1]);
        for (std::size_t k = 0; k < count; ++k) {
            const Real even = half * (a[k] + b[k]), odd = half * (a[k] - b[k]);
            a[k] = even;
            b[k] = odd;
        }
    }
    for (const auto& four : fours_) {
        Real *a = row(four[0]), *b = row(four[1]), *c = row(four[2]), *d = row(four[3]);
        for (std::size_t k = 0; k < count; ++k) {
            const Real even_1 = a[k] + b[k], odd_1 = a[k] - b[k];
            const Real even_2 = c[k] + d[k], odd_2 = c[k] - d[k];
            a[k] = 0.5 * (even_1 + even_2);
            b[k] = 0.5 * (odd_1 + odd_2);
            c[k] = 0.5 * (even_1 - even_2);
            d[k] = 0.5 * (odd_1 - odd_2);
        }
    }
}

} // namespace mpsdem::linear
