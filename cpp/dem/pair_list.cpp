#include "dem/pair_list.hpp"

#include <algorithm>
#include <array>

namespace mpsdem::dem {

void InnerPairs::clear() noexcept {
    size = cross_begin = 0;
    first.clear();
    second.clear();
    outer.clear();
    values.clear();
}

void InnerPairs::append(const Population& p, std::size_t i, std::size_t j, Real shift,
                        Index outer_pair, const History& history) {
    using P = Population;
    const Real r_i = p.at(P::RADIUS, i), r_j = p.at(P::RADIUS, j);
    first.push_back(static_cast<Index>(P::place(i)));
    second.push_back(static_cast<Index>(P::place(j)));
    outer.push_back(outer_pair);
    if (size % lanes == 0) values.resize(values.size() + lanes * field_count);
    const std::array<Real, field_count> row{
        shift,
        r_i + r_j,
        r_i * r_j / (r_i + r_j),
        1 / (p.at(P::INVERSE_MASS, i) + p.at(P::INVERSE_MASS, j)),
        1 / std::min(r_i, r_j),
        history.spring.x,
        history.spring.y,
        history.spring.z,
        history.roll.x,
        history.roll.y,
        history.roll.z};
    for (std::size_t f = 0; f < field_count; ++f) values[place(size) + f * lanes] = row[f];
    ++size;
}

void InnerPairs::pad(std::size_t self) {
    while (size % lanes != 0) {
        first.push_back(static_cast<Index>(Population::place(self)));
        second.push_back(first.back());
        outer.push_back(padding);
        const std::size_t at = place(size);
        values[at + RADIUS_SUM * lanes] = -1;
        values[at + REDUCED_RADIUS * lanes] = values[at + REDUCED_MASS * lanes] = 1;
        ++size;
    }
}

History InnerPairs::history(std::size_t slot) const noexcept {
    const Real* v = values.data() + place(slot);
    return {{v[SPRING_X * lanes], v[SPRING_Y * lanes], v[SPRING_Z * lanes]},
            {v[ROLL_X * lanes], v[ROLL_Y * lanes], v[ROLL_Z * lanes]}};
}

} // namespace mpsdem::dem
