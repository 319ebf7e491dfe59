#include "core/check.hpp"
#include "mps/eulerian/least_squares.hpp"
#include "mps/eulerian/liquid.hpp"
#include "mps/eulerian/viscous.hpp"

#include <algorithm>
#include <cmath>

/// The step of a liquid on nodes with solids in it.
namespace mpsdem::mps::eulerian {

namespace {

Vector<Lanes> load(const VectorField& f, std::size_t i, std::size_t k) noexcept {
    return {mpsdem::load(f.x[i] + k), mpsdem::load(f.y[i] + k), mpsdem::load(f.z[i] + k)};
}

void store(VectorField& f, std::size_t i, std::size_t k, const Vector<Lanes>& v) noexcept {
    mpsdem::store(f.x[i] + k, v.x);
    mpsdem::store(f.y[i] + k, v.y);
    mpsdem::store(f.z[i] + k, v.z);
}

/// Four vectors in a row.
void store(std::vector<Vec3>& to, std::size_t first, const Vector<Lanes>& v) noexcept {
    for (std::size_t l = 0; l < lane_count; ++l) to[first + l] = {v.x[l], v.y[l], v.z[l]};
}

Vec3 at(const VectorField& f, std::size_t i, std::size_t k) noexcept {
    return {f.x[i][k], f.y[i][k], f.z[i][k]};
}

void set(VectorField& f, std::size_t i, std::size_t k, const Vec3& v) noexcept {
    f.x[i][k] = v.x;
    f.y[i][k] = v.y;
    f.z[i][k] = v.z;
}

} // namespace

std::vector<Real> Loaded::packed() const {
    std::vector<Real> out{step_before, gradient, error_before, friction_before};
    const auto add = [&](const Field& f) {
        for (std::size_t i = 0; i < f.rows(); ++i) out.insert(out.end(), f[i], f[i] + f.stations());
    };
    for (const Field* f : {&eps, &pressure, &flux.x, &flux.y, &flux.z, &rate_before.x,
                           &rate_before.y, &rate_before.z})
        add(*f);
    for (const Vec3& a : acceleration) out.insert(out.end(), {a.x, a.y, a.z});
    return out;
}

void Loaded::unpack(std::span<const Real> numbers) {
    const std::size_t of_field = eps.rows() * eps.stations();
    constexpr std::size_t scalars = 4, fields = 8;
    const std::size_t known = scalars + fields * of_field;
    require(numbers.size() > known && (numbers.size() - known) % 3 == 0,
            "restore: the snapshot's load belongs to another liquid");
    const Real* next = numbers.data();
    for (Real* scalar : {&step_before, &gradient, &error_before, &friction_before})
        *scalar = *next++;
    for (Field* f : {&eps, &pressure, &flux.x, &flux.y, &flux.z, &rate_before.x, &rate_before.y,
                     &rate_before.z}) {
        for (std::size_t i = 0; i < f->rows(); ++i, next += f->stations())
            std::copy_n(next, f->stations(), (*f)[i]);
        f->wrap();
    }
    acceleration.resize((numbers.size() - known) / 3);
    for (Vec3& a : acceleration) {
        a = {next[0], next[1], next[2]};
        next += 3;
    }
}

LiquidPoints Liquid::points() {
    if (interior_position_.empty()) {
        // The inner nodes share the bore among them, as they share the force of its wall.
        const Real share = axial_.spacing * bore_area_ / interior_area_;
        for (std::size_t i = 0; i < section_.interior_count(); ++i) {
            for (std::size_t k = 0; k < stations(); ++k) {
                Vec3 x = section_.place(i);
                x.x = (static_cast<Real>(k) + 0.5) * axial_.spacing;
                interior_position_.push_back(x);
                interior_volume_.push_back(share * section_.area(i));
            }
        }
    }
    return {interior_position_, interior_volume_, pipe_length_, true};
}

std::span<const Vec3> Liquid::interior_velocity() {
    interior_velocity_.resize(section_.interior_count() * stations());
    parallel_for(section_.interior_count(), numerics_.threads, [&](std::size_t i) {
        for (std::size_t k = 0; k < stations(); ++k)
            interior_velocity_[i * stations() + k] = at(u_, i, k);
    });
    return interior_velocity_;
}

/// Put the load on nodes, and on the walls what it is inward of them.
void Liquid::take_load(const Load& load, Loaded& on) const {
    const std::size_t inner = section_.interior_count(), n = stations();
    parallel_for(inner, numerics_.threads, [&](std::size_t i) {
        for (std::size_t k = 0; k < n; ++k) {
            const LoadAt& at = load[i * n + k];
            on.eps[i][k] = at.void_fraction;
            on.beta[i][k] = at.drag / density_;
            set(on.flux, i, k, at.solids_flux);
            set(on.drag, i, k, (1 / density_) * at.drag_of_solids);
        }
    });
    parallel_for(section_.wall_count(), numerics_.threads, [&](std::size_t w) {
        const auto [node, share] = section_.inward(w);
        const Vec3 normal = section_.outward(inner + w);
        for (std::size_t k = 0; k < n; ++k) {
            const auto inward = [&](const Field& f) {
                return share[0] * f[node[0]][k] + share[1] * f[node[1]][k];
            };
            const auto inward_vector = [&](const VectorField& f) {
                return Vec3{inward(f.x), inward(f.y), inward(f.z)};
            };
            on.eps[inner + w][k] = inward(on.eps);
            on.beta[inner + w][k] = inward(on.beta);
            set(on.drag, inner + w, k, inward_vector(on.drag));
            set(on.flux, inner + w, k, tangential(inward_vector(on.flux), normal));
        }
    });
}

/// Mean of eps u_x over the inner nodes [m/s].
Real Liquid::interior_momentum(const Loaded& on) const {
    return interior_mean([&](std::size_t i) {
        Real row = 0;
        for (std::size_t k = 0; k < stations(); ++k) row += on.eps[i][k] * u_.x[i][k];
        return row;
    });
}

/// One substep; `transport` has left the convective acceleration in star_.
void Liquid::step_with_solids(Real dt, Loading& loading, Real elapsed, Real share,
                              AdvanceReport& report) {
    const bool first = !loaded_;
    Loaded& on = loaded_ ? *loaded_ : loaded_.emplace(section_.size(), stations());
    Real carried_to = interior_momentum(on);
    take_load(loading.before(points(), elapsed, dt), on);
    const Real before = interior_momentum(on);
    if (first) carried_to = before;
    const std::size_t inner = section_.interior_count();
    if (drive_.pressure_gradient) on.gradient = *drive_.pressure_gradient / density_;

    // du/dt by convection and viscosity; the walls' drag on the layer next to them.
    find_rates(on);
    const Real friction = -(flow_ == Flow::laminar ? mean(viscous_force_) / interior_area_
                                                   : mean(on.wall_drag) / bore_area_);
    // Adams and Bashforth's second order, for steps that may differ; Euler's for the first.
    const Real ahead = on.step_before > 0 ? dt / (2 * on.step_before) : 0;
    const auto extrapolated = [&](Real now, Real& earlier) {
        const Real value = now + ahead * (now - earlier);
        earlier = now;
        return value;
    };
    const Real taken = extrapolated(friction, on.friction_before);
    // Convection only moves momentum from place to place: what is not so is given back.
    const Real misplaced = dt * extrapolated(mean(convection_) / interior_area_, on.error_before) +
                           before - carried_to;

    // What the solids get is the drag on the velocity before its pressure is known.
    on.velocity.resize(inner * stations());
    interior_velocity_.resize(inner * stations());
    parallel_for(chunks_.count(), numerics_.threads, [&](std::size_t c) {
        const std::size_t begin = chunks_.begin(c), end = chunks_.end(c);
        for (std::size_t i = 0; i < section_.size(); ++i) {
            const bool is_wall = i >= inner;
            const auto entries = gradient_stencil_.of(i);
            const Vec3 n = is_wall ? section_.outward(i) : Vec3{};
            for (std::size_t k = begin; k < end; k += lane_count) {
                const auto slope = apply<1, 2>(entries, on.pressure, k);
                const Lanes eps = mpsdem::load(on.eps[i] + k);
                const Lanes damped = 1 / (1 + dt * mpsdem::load(on.beta[i] + k) / eps);
                Vector<Lanes> push = load(on.drag, i, k); // less the pressure's gradient
                push.x += on.gradient - axial_.first(on.pressure[i] + k);
                push.y -= slope.of[0][0];
                push.z -= slope.of[1][0];
                const Vector<Lanes> s = load(on.flux, i, k), u = load(u_, i, k);
                if (is_wall) { // no flux through it but what forces would push
                    const Lanes through = dt * damped * (push.y * n.y + push.z * n.z);
                    store(star_, i, k,
                          {eps * u.x + s.x, eps * u.y + s.y + through * n.y,
                           eps * u.z + s.z + through * n.z});
                    continue;
                }
                const Vector<Lanes> now = load(star_, i, k), earlier = load(on.rate_before, i, k);
                store(on.rate_before, i, k, now);
                Vector<Lanes> m =
                    eps * (u + (dt + Lanes{}) * (now + (ahead + Lanes{}) * (now - earlier)));
                m.x -= misplaced;
                m = damped * (m + (dt + Lanes{}) * push);
                const Vector<Lanes> next = (1 / eps) * m;
                store(u_, i, k, next);
                store(on.velocity, i * stations() + k, u);
                store(interior_velocity_, i * stations() + k, next);
                store(star_, i, k, m + s);
            }
            star_.x.wrap(i, begin, end);
        }
    });
    on.step_before = dt;

    find_divergence(star_, phi_);
    parallel_for(section_.wall_count(), numerics_.threads, [&](std::size_t w) {
        const std::size_t i = inner + w;
        const Vec3 n = section_.outward(i);
        for (std::size_t k = 0; k < stations(); k += lane_count)
            mpsdem::store(phi_[i] + k,
                          n.y * mpsdem::load(star_.y[i] + k) + n.z * mpsdem::load(star_.z[i] + k));
    });
    solver_.solve(linear::CrossSectionSolver::WallSource::given, numerics_.threads, phi_);

    const std::span<const Vec3> owed = loading.owed(interior_velocity_);
    const Real held = correct_with_solids(on, dt) / dt;
    const Real exchanged = settle_with_solids(on, dt, owed);
    const Real applied = on.gradient + held;
    on.gradient += stiffness(on, dt) * held;

    const Real after = interior_momentum(on);
    gradient_ = density_ * applied;
    pressure_scale_ = density_ / dt;
    report.mean_gradient += share * gradient_;
    report.friction += share * density_ * taken;
    report.convection_error += share * density_ * misplaced / dt;
    report.unexplained +=
        share * density_ * ((after - carried_to) / dt - applied + taken - exchanged);
}

/// How much more gradient than in clear liquid it takes to change the flux in a step [-]: before
/// its pressure is known, each place yields as its own drag lets it. So the gradient of a bed that
/// fills the pipe is found in a step or two, and one that fills a part of it is not overdone.
Real Liquid::stiffness(const Loaded& on, Real dt) const {
    return 1 / interior_mean([&](std::size_t i) {
               Real row = 0;
               for (std::size_t k = 0; k < stations(); ++k)
                   row += 1 / (1 + dt * on.beta[i][k] / on.eps[i][k]);
               return row;
           });
}

/// du/dt of the inner nodes into star_: convection stands there already.
void Liquid::find_rates(Loaded& on) {
    const std::size_t inner = section_.interior_count();
    on.wall_drag.assign(stations(), 0);
    convection_.assign(stations(), 0);
    parallel_for(section_.size(), numerics_.threads, [&](std::size_t i) {
        for (std::size_t k = 0; k < stations(); ++k)
            on.eps_viscosity[i][k] = on.eps[i][k] * nu_t_[i][k];
        on.eps_viscosity.wrap(i, 0, stations());
    });
    parallel_for(chunks_.count(), numerics_.threads, [&](std::size_t c) {
        const std::size_t begin = chunks_.begin(c), end = chunks_.end(c);
        for (std::size_t k = begin; k < end; ++k) viscous_force_[k] = 0;
        if (flow_ == Flow::turbulent) find_wall_drag(on, begin, end);
        for (std::size_t i = 0; i < inner; ++i) {
            const auto entries = laplacian_stencil_.of(i);
            const Real area = section_.area(i);
            for (std::size_t k = begin; k < end; k += lane_count) {
                const auto viscous = viscous_acceleration(entries, axial_, on.eps_viscosity, u_, i,
                                                          static_cast<std::ptrdiff_t>(k));
                const Lanes eps = mpsdem::load(on.eps[i] + k);
                const Vector<Lanes> carried = load(star_, i, k);
                mpsdem::store(&convection_[k],
                              mpsdem::load(&convection_[k]) + area * (eps * carried.x));
                mpsdem::store(&viscous_force_[k],
                              mpsdem::load(&viscous_force_[k]) + area * viscous.x);
                store(star_, i, k, carried + (1 / eps) * viscous);
            }
        }
        if (flow_ == Flow::laminar) return;
        // What the viscous terms lack of the wall's drag, where the wall drags: a bed has its share
        // of the wall, but not of what the liquid over it rubs off there.
        const std::span<const Index> layer = section_.layer();
        for (std::size_t k = begin; k < end; ++k) {
            const Real missing = on.wall_drag[k] * interior_area_ / bore_area_ - viscous_force_[k];
            const auto rubbed = [&](std::size_t l) {
                const auto [node, share] = section_.at_wall(l);
                const auto shear = [&](std::size_t i) {
                    const Real u_star = friction_velocity_[i - inner][k];
                    return on.eps[i][k] * u_star * u_star;
                };
                return share[0] * shear(node[0]) + share[1] * shear(node[1]);
            };
            Real all = 0; // [m4/s2]
            for (std::size_t l = 0; l < layer.size(); ++l)
                all += section_.area(layer[l]) * rubbed(l);
            if (all == 0) continue; // nothing moves along this wall
            for (std::size_t l = 0; l < layer.size(); ++l)
                star_.x[layer[l]][k] += missing * rubbed(l) / (all * on.eps[layer[l]][k]);
        }
    });
}

/// The liquid's share of the wall's drag, of the stations [begin, end).
void Liquid::find_wall_drag(Loaded& on, std::size_t begin, std::size_t end) const {
    const std::size_t inner = section_.interior_count();
    for (std::size_t w = 0; w < section_.wall_count(); ++w) {
        for (std::size_t k = begin; k < end; ++k) {
            const Vec3 slip = at(u_, inner + w, k);
            const Real speed = norm(slip), u_star = friction_velocity_[w][k];
            if (speed > 0)
                on.wall_drag[k] -=
                    section_.wall_share() * on.eps[inner + w][k] * u_star * u_star * slip.x / speed;
        }
    }
}

/// From the volume flux in star_ and its pressure to the liquid's velocity, the walls' too. Returns
/// what of the velocity was added along the pipe to hold the flux, or by the given gradient [m/s].
Real Liquid::correct_with_solids(Loaded& on, Real dt) {
    const std::size_t inner = section_.interior_count();
    parallel_for(chunks_.count(), numerics_.threads, [&](std::size_t c) {
        const std::size_t begin = chunks_.begin(c), end = chunks_.end(c);
        for (std::size_t i = 0; i < section_.size(); ++i) {
            const auto entries = gradient_stencil_.of(i);
            for (std::size_t k = begin; k < end; k += lane_count) {
                mpsdem::store(on.pressure[i] + k, mpsdem::load(on.pressure[i] + k) +
                                                      (1 / dt) * mpsdem::load(phi_[i] + k));
                if (i >= inner) continue;
                const auto slope = apply<1, 2>(entries, phi_, k);
                Vector<Lanes> w = load(star_, i, k);
                w.x -= axial_.first(phi_[i] + k);
                w.y -= slope.of[0][0];
                w.z -= slope.of[1][0];
                store(u_, i, k, (1 / mpsdem::load(on.eps[i] + k)) * (w - load(on.flux, i, k)));
            }
            on.pressure.wrap(i, begin, end);
        }
        meet_wall(begin, end);
    });
    if (drive_.pressure_gradient) return 0; // it stands in the gradient already
    const MixtureFlux flux = mixture_flux(on);
    const Real held = (drive_.bulk_velocity - flux.velocity) / flux.yield;
    parallel_for(inner, numerics_.threads, [&](std::size_t i) {
        for (std::size_t k = 0; k < stations(); ++k) u_.x[i][k] += held / on.eps[i][k];
    });
    return held;
}

/// Pay what the solids still owe, and note the acceleration that was not theirs. Returns what the
/// solids gave to the mean of eps u_x over the inner nodes [m/s2].
Real Liquid::settle_with_solids(Loaded& on, Real dt, std::span<const Vec3> owed) {
    on.acceleration.resize(owed.size());
    const Real given = interior_mean([&](std::size_t i) {
        Real row = 0;
        for (std::size_t k = 0; k < stations(); ++k) {
            const std::size_t p = i * stations() + k;
            const Real eps = on.eps[i][k];
            const Vec3 drag = at(on.drag, i, k) - on.beta[i][k] * interior_velocity_[p];
            on.acceleration[p] = (1 / dt) * (at(u_, i, k) - on.velocity[p]) - (1 / eps) * drag;
            set(u_, i, k, at(u_, i, k) + (1 / (density_ * eps)) * owed[p]);
            row += drag.x + owed[p].x / (density_ * dt);
        }
        return row;
    });
    u_.x.wrap();
    u_.y.wrap();
    u_.z.wrap();
    return given;
}

/// eps u + s.
void Liquid::find_volume_flux(const Loaded& on, VectorField& result) const {
    for (std::size_t i = 0; i < section_.size(); ++i) {
        for (std::size_t k = 0; k < stations(); ++k)
            set(result, i, k, on.eps[i][k] * at(u_, i, k) + at(on.flux, i, k));
        result.x.wrap(i, 0, stations());
    }
}

std::vector<Real> Liquid::void_fraction() const {
    std::vector<Real> out(size(), 1);
    if (!loaded_) return out;
    for (std::size_t i = 0; i < section_.size(); ++i)
        std::copy_n(loaded_->eps[i], stations(), out.data() + i * stations());
    return out;
}

Liquid::MixtureFlux Liquid::mixture_flux(const Loaded& on) const {
    // The solids are spread over the inner nodes, which share the bore among them.
    const Real solids =
        interior_mean([&](std::size_t i) { return total({on.flux.x[i], stations()}); });
    MixtureFlux sum{interior_momentum(on) * interior_area_, interior_area_};
    // Where drag outweighs viscosity over a spacing, the wall slows less than half of it: what its
    // nodes stand for goes with the liquid inward of them, as in a packed bed.
    of_wall_.resize(section_.wall_count());
    parallel_for(section_.wall_count(), numerics_.threads, [&](std::size_t w) {
        const std::size_t i = section_.interior_count() + w;
        const auto [node, share] = section_.inward(w);
        MixtureFlux row{};
        for (std::size_t k = 0; k < stations(); ++k) {
            const auto inward = [&](const Field& f) {
                return share[0] * f[node[0]][k] + share[1] * f[node[1]][k];
            };
            const Real eps = on.eps[i][k], spacing = section_.spacing();
            const Real drag = on.beta[i][k] * spacing * spacing / (eps * inward(nu_t_));
            const Real through = drag / (1 + drag), u = u_.x[i][k];
            row.velocity += eps * (u + through * (inward(u_.x) - u));
            row.yield +=
                eps * through * (share[0] / on.eps[node[0]][k] + share[1] / on.eps[node[1]][k]);
        }
        of_wall_[w] = {section_.area(i) * row.velocity, section_.area(i) * row.yield};
    });
    MixtureFlux walls{};
    for (const MixtureFlux& of_wall : of_wall_) {
        walls.velocity += of_wall.velocity;
        walls.yield += of_wall.yield;
    }
    const auto n = static_cast<Real>(stations());
    return {(sum.velocity + walls.velocity / n) / bore_area_ + solids,
            (sum.yield + walls.yield / n) / bore_area_};
}

} // namespace mpsdem::mps::eulerian
