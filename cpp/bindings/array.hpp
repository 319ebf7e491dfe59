#pragma once

#include "core/check.hpp"
#include "core/vec3.hpp"

#include <pybind11/numpy.h>

#include <span>
#include <string>
#include <vector>

namespace mpsdem::bindings {

namespace py = pybind11;

/// An input array. A narrower type or another layout is copied, a lossy conversion is a TypeError;
/// as the copy may be a temporary, results are returned and never written through an argument.
template <class T>
using Array = py::array_t<T, py::array::c_style>;

/// See an (n, 3) array as n vectors without a copy.
inline std::span<const Vec3> vectors(const Array<Real>& a, const char* name) {
    require(a.ndim() == 2 && a.shape(1) == 3, std::string(name) + " must have shape (n, 3)");
    return {reinterpret_cast<const Vec3*>(a.data()), static_cast<std::size_t>(a.shape(0))};
}

inline Vec3 vector(const Array<Real>& a, const char* name) {
    require(a.ndim() == 1 && a.shape(0) == 3, std::string(name) + " must have shape (3,)");
    return {a.at(0), a.at(1), a.at(2)};
}

template <class T>
std::span<const T> values(const Array<T>& a, const char* name) {
    require(a.ndim() == 1, std::string(name) + " must have shape (n,)");
    return {a.data(), static_cast<std::size_t>(a.size())};
}

inline Array<Real> array(Vec3 v) {
    return Array<Real>(3, &v.x);
}

template <class T>
Array<T> array(const std::vector<T>& v) {
    return Array<T>(static_cast<py::ssize_t>(v.size()), v.data());
}

inline Array<Real> array(const std::vector<Vec3>& v) {
    Array<Real> a({static_cast<py::ssize_t>(v.size()), py::ssize_t{3}});
    std::copy(v.begin(), v.end(), reinterpret_cast<Vec3*>(a.mutable_data()));
    return a;
}

} // namespace mpsdem::bindings
