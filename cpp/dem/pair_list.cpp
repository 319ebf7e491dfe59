#include "dem/pair_list.hpp"

#include <algorithm>

namespace mpsdem::dem {

void OuterPairs::clear() noexcept {
    first.clear();
    second.clear();
    image.clear();
}

void OuterPairs::append(std::size_t i, std::size_t j, int image_x) {
    first.push_back(static_cast<Index>(i));
    second.push_back(static_cast<Index>(j));
    image.push_back(static_cast<std::int8_t>(image_x));
}

void OuterPairs::append(const OuterPairs& other) {
    first.insert(first.end(), other.first.begin(), other.first.end());
    second.insert(second.end(), other.second.begin(), other.second.end());
    image.insert(image.end(), other.image.begin(), other.image.end());
}

void OuterPairs::find_near(const Population& p, Real period, Real skin, std::size_t begin,
                           std::size_t end, std::vector<Index>& near) const {
    near.resize(end - begin + lane_count);
    std::size_t size = 0;
    for (std::size_t at = begin; at < end; at += lane_count) {
        Lanes x_i[lane_count], x_j[lane_count], shift{};
        for (std::size_t k = 0; k < lane_count; ++k) {
            const std::size_t pair = std::min(at + k, end - 1);
            x_i[k] = load(p.at(Population::X, first[pair]));
            x_j[k] = load(p.at(Population::X, second[pair]));
            shift[k] = image[pair] * period;
        }
        const Columns i = turned(x_i[0], x_i[1], x_i[2], x_i[3]);
        const Columns j = turned(x_j[0], x_j[1], x_j[2], x_j[3]);
        Vector<Lanes> d = i.v - j.v;
        d.x += shift;
        const Lanes range = i.w + j.w + skin;
        const unsigned close = bits(dot(d, d) < range * range);
        for (std::size_t k = 0; k < std::min(lane_count, end - at); ++k) {
            near[size] = static_cast<Index>(at + k);
            size += close >> k & 1u;
        }
    }
    near.resize(size);
}

void InnerPairs::clear() noexcept {
    size = cross_begin = 0;
    first.clear();
    second.clear();
    outer.clear();
    shift.clear();
    radius_sum.clear();
    values.clear();
    touched.clear();
}

void InnerPairs::reserve(std::size_t slots) {
    first.reserve(slots);
    second.reserve(slots);
    outer.reserve(slots);
    shift.reserve(slots);
    radius_sum.reserve(slots);
    values.reserve(slots * record);
    touched.reserve(slots / lane_count + 1);
}

void InnerPairs::append(const Population& p, std::size_t i, std::size_t j, Real shift_x,
                        Index outer_pair) {
    using P = Population;
    const Real r_i = *p.at(P::RADIUS, i), r_j = *p.at(P::RADIUS, j);
    first.push_back(static_cast<Index>(P::place(i)));
    second.push_back(static_cast<Index>(P::place(j)));
    outer.push_back(outer_pair);
    shift.push_back(shift_x);
    radius_sum.push_back(r_i + r_j);
    const Real reduced_mass = 1 / (*p.at(P::INVERSE_MASS, i) + *p.at(P::INVERSE_MASS, j));
    const Real row[record] = {0, 0, 0, r_i * r_j / (r_i + r_j), 0, 0, 0, reduced_mass};
    values.insert(values.end(), row, row + record);
    if (size % lane_count == 0) touched.push_back(0);
    ++size;
}

void InnerPairs::append(const InnerPairs& from, std::size_t slot) {
    first.push_back(from.first[slot]);
    second.push_back(from.second[slot]);
    outer.push_back(from.outer[slot]);
    shift.push_back(from.shift[slot]);
    radius_sum.push_back(from.radius_sum[slot]);
    const Real* const row = from.values.data() + slot * record;
    values.insert(values.end(), row, row + record);
    if (size % lane_count == 0) touched.push_back(0);
    const unsigned touches = from.touched[slot / lane_count] >> slot % lane_count & 1u;
    touched.back() |= static_cast<std::uint8_t>(touches << size % lane_count);
    ++size;
}

void InnerPairs::set_history(std::size_t slot, const History& h) noexcept {
    Real* const pair = values.data() + slot * record;
    pair[SPRING] = h.spring.x;
    pair[SPRING + 1] = h.spring.y;
    pair[SPRING + 2] = h.spring.z;
    pair[ROLL] = h.roll.x;
    pair[ROLL + 1] = h.roll.y;
    pair[ROLL + 2] = h.roll.z;
    if (h != History{})
        touched[slot / lane_count] |= static_cast<std::uint8_t>(1u << slot % lane_count);
}

History InnerPairs::history(std::size_t slot) const noexcept {
    const Real* const pair = values.data() + slot * record;
    return {{pair[SPRING], pair[SPRING + 1], pair[SPRING + 2]},
            {pair[ROLL], pair[ROLL + 1], pair[ROLL + 2]}};
}

void InnerPairs::pad(std::size_t self) {
    while (size % lane_count != 0) {
        first.push_back(static_cast<Index>(Population::place(self)));
        second.push_back(first.back());
        outer.push_back(outer.back()); // keeps the order
        shift.push_back(0);
        radius_sum.push_back(0);
        values.resize(values.size() + record);
        ++size;
    }
}

} // namespace mpsdem::dem
