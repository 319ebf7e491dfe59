#include "core/parallel.hpp"

#include <pybind11/pybind11.h>

#include <string>

namespace mpsdem::bindings {

void bind_geometry(pybind11::module_ m);
void bind_neighbors(pybind11::module_ m);
void bind_linear(pybind11::module_ m);
void bind_cross_section(pybind11::module_ m);
void bind_dem(pybind11::module_ m);
void bind_mps(pybind11::module_ m);
void bind_mps_operators(pybind11::module_ m);
void bind_lagrangian(pybind11::module_ m);
void bind_eulerian(pybind11::module_ m);
void bind_coupling(pybind11::module_ m);
void bind_exchange(pybind11::module_ m);

namespace {

const char* simd_level() {
#if defined(__AVX512F__)
    return "AVX-512";
#elif defined(__AVX2__)
    return "AVX2";
#elif defined(__AVX__)
    return "AVX";
#elif defined(__SSE2__)
    return "SSE2";
#elif defined(__ARM_NEON)
    return "NEON";
#else
    return "none";
#endif
}

std::string compiler() {
#if defined(__clang__)
    return "clang " __clang_version__;
#else
    return "gcc " __VERSION__;
#endif
}

} // namespace
} // namespace mpsdem::bindings

PYBIND11_MODULE(_core, m) {
    namespace b = mpsdem::bindings;
    m.doc() = "Compiled kernels of mpsdem. SI units throughout.";
    m.attr("version") = MPSDEM_VERSION;
    m.attr("compiler") = b::compiler();
    m.attr("simd") = b::simd_level();
    m.attr("cholmod") = MPSDEM_CHOLMOD; // version of the library, empty where it was not found
    m.def("available_threads", &mpsdem::available_threads,
          "Threads that a parallel loop may use (OMP_NUM_THREADS, else the processors).");

    b::bind_geometry(m.def_submodule("geometry"));
    b::bind_neighbors(m.def_submodule("neighbors"));
    const auto linear = m.def_submodule("linear");
    b::bind_linear(linear);
    b::bind_cross_section(linear);
    b::bind_dem(m.def_submodule("dem"));
    const auto mps = m.def_submodule("mps");
    b::bind_mps(mps);
    b::bind_mps_operators(mps);
    b::bind_lagrangian(mps);
    b::bind_eulerian(mps);
    const auto coupling = m.def_submodule("coupling");
    b::bind_coupling(coupling);
    b::bind_exchange(coupling);
}
