#pragma once

#include "core/vec3.hpp"

namespace mpsdem::mps {

/// The symmetric matrix M = sum_j W r r^T / r^2 of a neighborhood. M^-1 corrects a first-order
/// operator, so that it is exact for linear fields wherever the neighbors are.
/// Source: Khayyer & Gotoh (2011), doi:10.1016/j.jcp.2011.01.009.
struct Moment {
    Real xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

    void add(Real factor, const Vec3& r) noexcept {
        xx += factor * r.x * r.x;
        yy += factor * r.y * r.y;
        zz += factor * r.z * r.z;
        xy += factor * r.x * r.y;
        xz += factor * r.x * r.z;
        yz += factor * r.y * r.z;
    }
    [[nodiscard]] Real determinant() const noexcept {
        return xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    }
    /// Whether the neighbors lie, to round-off's reach, in a plane or are fewer than three: then a
    /// direction is missing and there is no inverse. 1 is a full neighborhood.
    [[nodiscard]] bool flat() const noexcept {
        const Real mean = (xx + yy + zz) / 3;
        return !(determinant() > flat_limit * mean * mean * mean);
    }
    /// M^-1 b; only where not flat.
    [[nodiscard]] Vec3 solve(const Vec3& b) const noexcept {
        const Real scale = 1 / determinant();
        return {scale * ((yy * zz - yz * yz) * b.x + (xz * yz - xy * zz) * b.y +
                         (xy * yz - xz * yy) * b.z),
                scale * ((xz * yz - xy * zz) * b.x + (xx * zz - xz * xz) * b.y +
                         (xy * xz - xx * yz) * b.z),
                scale * ((xy * yz - xz * yy) * b.x + (xy * xz - xx * yz) * b.y +
                         (xx * yy - xy * xy) * b.z)};
    }

private:
    static constexpr Real flat_limit = 1e-4; // [-] determinant over that of a full neighborhood
};

} // namespace mpsdem::mps
