#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace mpsdem {

using Real = double;
using Index = std::uint32_t;

/// A vector in space, by value. Three doubles in a row, so that an (n, 3) array is n of them.
struct Vec3 {
    Real x{}, y{}, z{};

    constexpr Vec3& operator+=(Vec3 b) noexcept {
        x += b.x;
        y += b.y;
        z += b.z;
        return *this;
    }
    constexpr Vec3& operator-=(Vec3 b) noexcept {
        x -= b.x;
        y -= b.y;
        z -= b.z;
        return *this;
    }
    friend constexpr Vec3 operator+(Vec3 a, Vec3 b) noexcept {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend constexpr Vec3 operator-(Vec3 a, Vec3 b) noexcept {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend constexpr Vec3 operator-(Vec3 a) noexcept { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vec3 operator*(Real s, Vec3 a) noexcept { return {s * a.x, s * a.y, s * a.z}; }
    friend constexpr bool operator==(Vec3 a, Vec3 b) noexcept = default;
};

[[nodiscard]] constexpr Real dot(Vec3 a, Vec3 b) noexcept {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

[[nodiscard]] constexpr Vec3 cross(Vec3 a, Vec3 b) noexcept {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

[[nodiscard]] inline Real norm(Vec3 a) noexcept { return std::sqrt(dot(a, a)); }

/// The part of `a` that is normal to the unit vector `normal`.
[[nodiscard]] constexpr Vec3 tangential(Vec3 a, Vec3 normal) noexcept {
    return a - dot(a, normal) * normal;
}

} // namespace mpsdem
