#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace mpsdem {

using Real = double;
using Index = std::uint32_t;

/// A vector in space, by value; T is Real, or Lanes for one vector in each lane.
template <class T>
struct Vector {
    T x{}, y{}, z{};

    constexpr Vector& operator+=(const Vector& b) noexcept {
        x += b.x;
        y += b.y;
        z += b.z;
        return *this;
    }
    constexpr Vector& operator-=(const Vector& b) noexcept {
        x -= b.x;
        y -= b.y;
        z -= b.z;
        return *this;
    }
    friend constexpr Vector operator+(const Vector& a, const Vector& b) noexcept {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend constexpr Vector operator-(const Vector& a, const Vector& b) noexcept {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend constexpr Vector operator-(const Vector& a) noexcept { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vector operator*(const T& s, const Vector& a) noexcept {
        return {s * a.x, s * a.y, s * a.z};
    }
    friend constexpr bool operator==(const Vector& a, const Vector& b) noexcept = default;
};

/// Three doubles in a row, so that an (n, 3) array is n of them.
using Vec3 = Vector<Real>;

template <class T>
[[nodiscard]] constexpr T dot(const Vector<T>& a, const Vector<T>& b) noexcept {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
[[nodiscard]] constexpr Vector<T> cross(const Vector<T>& a, const Vector<T>& b) noexcept {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

[[nodiscard]] inline Real norm(const Vec3& a) noexcept {
    return std::sqrt(dot(a, a));
}

/// The part of `a` that is normal to the unit vector `normal`.
template <class T>
[[nodiscard]] constexpr Vector<T> tangential(const Vector<T>& a, const Vector<T>& normal) noexcept {
    return a - dot(a, normal) * normal;
}

} // namespace mpsdem
