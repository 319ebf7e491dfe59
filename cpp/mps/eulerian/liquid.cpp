#include "mps/eulerian/liquid.hpp"

#include "core/check.hpp"
#include "mps/eulerian/least_squares.hpp"
#include "mps/eulerian/viscous.hpp"

#include <chrono>
#include <cmath>
#include <limits>
#include <string>

namespace mpsdem::mps::eulerian {

namespace {

constexpr Real most_substeps = 1e5; // of one call; beyond it the speeds have run away
// [-] of the step at which the Runge-Kutta scheme leaves the negative real axis, on which viscosity
// has its eigenvalues: 2 for two stages, 2.51 for three. The rest is for convection.
constexpr Real viscous_share = 0.8;
// [-] the same with solids: one stage of Adams and Bashforth, which leaves the axis at 1, upwind
// convection in it, and a viscosity over the void fraction; measured: 1.3 held, 1.6 did not, as the
// bound is one from above
constexpr Real viscous_limit_with_solids = 0.9;
// [-] the same where solids crowd the pipe: a packed bed swung at 0.9
constexpr Real viscous_limit_in_a_crowd = 0.6;
constexpr Real crowd = 0.1;                // [-] mean solid fraction
constexpr Real courant_with_solids = 0.45; // [-] measured: 0.6 held, 0.78 did not

struct Weights {
    std::size_t count;
    Real kept[3]; // a of each stage
};

Weights weights_of(Scheme scheme) {
    if (scheme == Scheme::rk2) return {2, {0, 1. / 2, 0}};
    return {3, {0, 3. / 4, 1. / 3}};
}

Real viscous_limit(Scheme scheme) {
    return viscous_share * (scheme == Scheme::rk2 ? 2.0 : 2.51);
}

linear::CrossSectionSolver solver_of(const Section& section, const Stencil<2>& gradient,
                                     const Stencil<1>& laplacian, const Axial& axial,
                                     std::size_t stations) {
    const std::size_t all = section.size(), inner = section.interior_count();
    const std::vector<Real> interior = laplacian.dense(all, 0);
    const std::vector<Real> y = gradient.dense(all, 0), z = gradient.dense(all, 1);
    std::vector<Real> wall(section.wall_count() * all);
    for (std::size_t w = 0; w < section.wall_count(); ++w) {
        const Vec3 n = section.outward(inner + w);
        for (std::size_t j = 0; j < all; ++j) {
            const std::size_t at = (inner + w) * all + j;
            wall[w * all + j] = n.y * y[at] + n.z * z[at];
        }
    }
    std::vector<Index> across = section.image({0, -1, 1}), down = section.image({0, 1, -1});
    if (across.empty() || down.empty()) across = down = {};
    return {std::span(interior).first(inner * all), wall,     inner,         section.wall_count(),
            axial.second_symbol(stations),          stations, {across, down}};
}

} // namespace

Liquid::Liquid(const Section& section, Real pipe_length, std::span<const Vec3> velocity,
               Real density, Real kinematic_viscosity, Real roughness, Flow flow,
               const Drive& drive, const Numerics& numerics)
    : section_(section), pipe_length_(pipe_length),
      axial_{pipe_length / static_cast<Real>(numerics.stations)}, chunks_(numerics.stations),
      density_(density), viscosity_(kinematic_viscosity), flow_(flow), drive_(drive),
      numerics_(numerics), wall_law_(kinematic_viscosity, roughness, section),
      mixing_length_(section.pipe_radius()), gradient_stencil_(gradient_stencil(section)),
      laplacian_stencil_(laplacian_stencil(section)),
      upwind_stencil_(numerics.convection == Convection::upwind ? upwind_stencil(section)
                                                                : Stencil<4>()),
      viscous_bound_(laplacian_stencil_.bound(section.interior_count(), 0) +
                     4 / (axial_.spacing * axial_.spacing)),
      bore_area_(section.bore_area()), interior_area_(section.interior_area()),
      layer_area_(section.area(section.layer())),
      solver_(solver_of(section, gradient_stencil_, laplacian_stencil_, axial_, numerics.stations)),
      u_(section.size(), numerics.stations), start_(section.size(), numerics.stations),
      star_(section.size(), numerics.stations), strain_(section.size(), numerics.stations),
      nu_t_(section.size(), numerics.stations), phi_(section.size(), numerics.stations),
      friction_velocity_(section.wall_count(), numerics.stations), drag_(numerics.stations),
      flux_(numerics.stations), viscous_force_(numerics.stations), of_chunk_(chunks_.count()) {
    require(pipe_length > 0, "Liquid: pipe_length must be > 0 m");
    require(numerics.stations >= 8 && numerics.stations % lane_count == 0,
            "Liquid: stations must be a multiple of 4, and at least 8");
    require(velocity.size() == size(),
            "Liquid: velocity must have one vector per node and station");
    require(density > 0, "Liquid: density must be > 0 kg/m3");
    require(numerics.courant > 0, "Liquid: courant must be > 0");
    require(numerics.threads >= 1, "Liquid: threads must be >= 1");
    if (numerics.convection == Convection::muscl) {
        gradients_.y = VectorField(section.size(), stations());
        gradients_.z = VectorField(section.size(), stations());
    }
    for (std::size_t i = 0; i < section_.size(); ++i) {
        std::fill_n(nu_t_[i], stations(), viscosity_);
        nu_t_.wrap(i, 0, stations());
        if (i >= section_.interior_count()) continue;
        for (std::size_t k = 0; k < stations(); ++k) {
            const Vec3& v = velocity[i * stations() + k];
            u_.x[i][k] = v.x;
            u_.y[i][k] = v.y;
            u_.z[i][k] = v.z;
        }
    }
    for (std::size_t c = 0; c < chunks_.count(); ++c) meet_wall(chunks_.begin(c), chunks_.end(c));
    u_.x.wrap();
    u_.y.wrap();
    u_.z.wrap();
}

AdvanceReport Liquid::advance(Real dt, Loading* loading) {
    require(dt > 0, "advance: dt must be > 0 s");
    require(loading == nullptr || (source_.x.rows() == 0 && body_force_ == Vec3{}),
            "advance: no body force or source in a liquid with solids");
    AdvanceReport report;
    const Weights weights = weights_of(numerics_.scheme);
    report.shortest = std::numeric_limits<Real>::infinity();
    const Real before = mean_interior_velocity();
    if (loading == nullptr) loaded_.reset();
    for (Real left = dt; left > 1e-9 * dt;) {
        transport();
        const Real count = std::ceil(left / allowed(loading != nullptr, report) - 1e-9);
        report.sound = count < most_substeps;
        if (!report.sound) break;
        const Real length = left / std::max(count, 1.);
        if (loading != nullptr) {
            step_with_solids(length, *loading, dt - left, length / dt, report);
            left -= length;
            ++report.substeps;
            continue;
        }
        Real driven = 0, taken = 0; // [m/s] given and taken along the pipe over the substep
        for (std::size_t s = 0; s < weights.count; ++s) {
            const Stage stage{weights.kept[s], length};
            const Real share = 1 - stage.kept;
            if (s > 0) transport();
            predict(stage);
            if (s == 0) std::swap(u_, start_);
            taken = share * (taken + length * mean_drag() / interior_area_);
            const Real given = share * length / density_ * drive_.pressure_gradient.value_or(0);
            const Real held =
                (drive_.bulk_velocity - mean(flux_) / bore_area_) * bore_area_ / interior_area_;
            const Real kick = drive_.pressure_gradient ? given : held;
            project(stage, report);
            driven = share * driven + kick + correct(kick);
        }
        gradient_ = density_ * driven / length;
        left -= length;
        ++report.substeps;
        report.mean_gradient += density_ * driven / dt;
        report.friction -= density_ * taken / dt;
    }
    if (report.substeps == 1) report.limit = Limit::none;
    if (loading == nullptr)
        report.unexplained = density_ * (mean_interior_velocity() - before) / dt -
                             report.mean_gradient + report.friction -
                             density_ * (body_force_.x + source_velocity_rate());
    report.divergence = residual_divergence();
    report.sound = report.sound && std::isfinite(report.divergence);
    return report;
}

/// -(u . grad) u into star_, and the viscosity.
void Liquid::transport() {
    const Carried out{star_, strain_};
    const CrossDamping damping = flow_ == Flow::laminar ? laminar_damping : turbulent_damping;
    if (numerics_.convection == Convection::muscl) {
        parallel_for(chunks_.count(), numerics_.threads, [&](std::size_t c) {
            const std::size_t begin = chunks_.begin(c), end = chunks_.end(c);
            gradient_across(gradient_stencil_, u_.x, begin, end, gradients_.y.x, gradients_.z.x);
            gradient_across(gradient_stencil_, u_.y, begin, end, gradients_.y.y, gradients_.z.y);
            gradient_across(gradient_stencil_, u_.z, begin, end, gradients_.y.z, gradients_.z.z);
        });
    }
    parallel_for(chunks_.count(), numerics_.threads, [&](std::size_t c) {
        const std::size_t begin = chunks_.begin(c), end = chunks_.end(c);
        if (numerics_.convection == Convection::muscl)
            carry_muscl(section_, gradient_stencil_, axial_, damping, u_, gradients_, begin, end,
                        out);
        else
            carry_upwind(section_, upwind_stencil_, axial_, damping, u_, begin, end, out);
        of_chunk_[c] = flow_ == Flow::turbulent
                           ? wall_law_.viscosity(section_, mixing_length_, strain_,
                                                 friction_velocity_, begin, end, nu_t_)
                           : viscosity_;
    });
    largest_viscosity_ = 0;
    for (const Real nu : of_chunk_) largest_viscosity_ = std::max(largest_viscosity_, nu);
}

/// Viscous limit with solids, by how much of the pipe they fill [-].
Real Liquid::viscous_limit_loaded() const {
    if (!loaded_) return viscous_limit_with_solids;
    const Real liquid =
        interior_mean([&](std::size_t i) { return total({loaded_->eps[i], stations()}); });
    return 1 - liquid < crowd ? viscous_limit_with_solids : viscous_limit_in_a_crowd;
}

/// Longest step that is stable now [s]; not a number where a speed is none.
Real Liquid::allowed(bool with_solids, AdvanceReport& report) {
    parallel_for(chunks_.count(), numerics_.threads, [&](std::size_t c) {
        Lanes most{}, bad{};
        for (std::size_t i = 0; i < section_.size(); ++i) {
            for (std::size_t k = chunks_.begin(c); k < chunks_.end(c); k += lane_count) {
                const Lanes y = load(u_.y[i] + k), z = load(u_.z[i] + k);
                const Lanes rate = (1 / axial_.spacing) * abs(load(u_.x[i] + k)) +
                                   (1 / section_.spacing()) * sqrt(y * y + z * z);
                most = max(most, rate);
                bad += 0 * rate; // not a number where the rate is none, or infinite
            }
        }
        of_chunk_[c] = largest(most) + sum(bad);
    });
    Real most = 0;
    for (const Real rate : of_chunk_) {
        if (std::isnan(rate)) return rate;
        most = std::max(most, rate);
    }
    const Real courant =
        (with_solids ? std::min(numerics_.courant, courant_with_solids) : numerics_.courant) / most;
    const Real viscous = (with_solids ? viscous_limit_loaded() : viscous_limit(numerics_.scheme)) /
                         (viscous_bound_ * largest_viscosity_);
    const Real step = std::min(courant, viscous);
    if (step < report.shortest) {
        report.shortest = step;
        report.limit = courant < viscous ? Limit::courant : Limit::viscosity;
    }
    return step;
}

/// u* from the accelerations in star_, and its flux through each plane.
void Liquid::predict(const Stage& stage) {
    const Real kept = stage.kept, share = 1 - kept;
    const bool turbulent = flow_ == Flow::turbulent, sourced = source_.x.rows() > 0;
    const Vector<Lanes> body{body_force_.x + Lanes{}, body_force_.y + Lanes{},
                             body_force_.z + Lanes{}};
    parallel_for(chunks_.count(), numerics_.threads, [&](std::size_t c) {
        const std::size_t begin = chunks_.begin(c), end = chunks_.end(c);
        const std::size_t inner = section_.interior_count();
        std::fill(viscous_force_.begin() + static_cast<std::ptrdiff_t>(begin),
                  viscous_force_.begin() + static_cast<std::ptrdiff_t>(end), 0);
        for (std::size_t i = 0; i < inner; ++i) {
            const auto entries = laplacian_stencil_.of(i);
            const Real area = section_.area(i);
            for (std::size_t k = begin; k < end; k += lane_count) {
                const auto viscous = viscous_acceleration(entries, axial_, nu_t_, u_, i,
                                                          static_cast<std::ptrdiff_t>(k));
                Vector<Lanes> a = viscous + body;
                if (sourced) {
                    a += Vector<Lanes>{load(source_.x[i] + k), load(source_.y[i] + k),
                                       load(source_.z[i] + k)};
                }
                const auto advanced = [&](const Field& u, const Field& start, Field& star,
                                          Lanes acceleration) {
                    acceleration += load(star[i] + k);
                    Lanes value = load(u[i] + k) + stage.dt * acceleration;
                    if (kept > 0) value = kept * load(start[i] + k) + share * value;
                    store(star[i] + k, value);
                };
                advanced(u_.x, start_.x, star_.x, a.x);
                advanced(u_.y, start_.y, star_.y, a.y);
                advanced(u_.z, start_.z, star_.z, a.z);
                store(&viscous_force_[k], load(&viscous_force_[k]) + area * viscous.x);
            }
        }
        if (turbulent) { // the viscous terms of a plane sum to the wall's drag on it
            for (const Index i : section_.layer()) {
                for (std::size_t k = begin; k < end; ++k) {
                    const Real missing = drag_[k] * interior_area_ / bore_area_ - viscous_force_[k];
                    star_.x[i][k] += share * stage.dt * missing / layer_area_;
                }
            }
        }
        for (std::size_t i = inner; i < section_.size(); ++i) {
            // The wall takes part in the divergence with all that acts on the liquid there, so that
            // a uniform acceleration has none; the pressure then undoes it.
            const auto entries = laplacian_stencil_.of(i);
            for (std::size_t k = begin; k < end; k += lane_count) {
                Vector<Lanes> a = body;
                if (sourced) {
                    a += Vector<Lanes>{load(source_.x[i] + k), load(source_.y[i] + k),
                                       load(source_.z[i] + k)};
                }
                if (!turbulent) {
                    a += viscous_acceleration(entries, axial_, nu_t_, u_, i,
                                              static_cast<std::ptrdiff_t>(k));
                }
                const Lanes time = share * stage.dt + Lanes{};
                store(star_.x[i] + k, load(u_.x[i] + k));
                store(star_.y[i] + k, load(u_.y[i] + k) + time * a.y);
                store(star_.z[i] + k, load(u_.z[i] + k) + time * a.z);
            }
        }
        std::fill(flux_.begin() + static_cast<std::ptrdiff_t>(begin),
                  flux_.begin() + static_cast<std::ptrdiff_t>(end), 0);
        for (std::size_t i = 0; i < section_.size(); ++i) {
            for (std::size_t k = begin; k < end; k += lane_count)
                store(&flux_[k], load(&flux_[k]) + section_.area(i) * load(star_.x[i] + k));
            star_.x.wrap(i, begin, end);
        }
    });
}

/// Divergence at the inner nodes [1/s].
void Liquid::find_divergence(const VectorField& field, Field& result) {
    parallel_for(chunks_.count(), numerics_.threads, [&](std::size_t c) {
        for (std::size_t i = 0; i < section_.interior_count(); ++i) {
            const auto entries = gradient_stencil_.of(i);
            for (std::size_t k = chunks_.begin(c); k < chunks_.end(c); k += lane_count) {
                Lanes sum = axial_.first(field.x[i] + k);
                for (const auto& e : entries) {
                    sum += e.weight[0] * load(field.y[e.node] + k) +
                           e.weight[1] * load(field.z[e.node] + k);
                }
                store(result[i] + k, sum);
            }
        }
    });
}

/// Pressure of u*: phi.
void Liquid::project(const Stage& stage, AdvanceReport& report) {
    find_divergence(star_, phi_);
    const bool at_wall =
        flow_ == Flow::laminar || source_.x.rows() > 0 || body_force_.y != 0 || body_force_.z != 0;
    if (at_wall) {
        parallel_for(section_.wall_count(), numerics_.threads, [&](std::size_t w) {
            const std::size_t i = section_.interior_count() + w;
            const Vec3 n = section_.outward(i);
            for (std::size_t k = 0; k < stations(); k += lane_count)
                store(phi_[i] + k, n.y * load(star_.y[i] + k) + n.z * load(star_.z[i] + k));
        });
    }
    using Source = linear::CrossSectionSolver::WallSource;
    const auto start = std::chrono::steady_clock::now();
    solver_.solve(at_wall ? Source::given : Source::none, numerics_.threads, phi_);
    report.solve_seconds +=
        std::chrono::duration<Real>(std::chrono::steady_clock::now() - start).count();
    pressure_scale_ = density_ / ((1 - stage.kept) * stage.dt);
}

/// u = u* - grad phi + the kick along the pipe [m/s]; then exactly what holds the bulk velocity.
/// Returns that last part.
Real Liquid::correct(Real kick) {
    const std::size_t inner = section_.interior_count();
    parallel_for(chunks_.count(), numerics_.threads, [&](std::size_t c) {
        const std::size_t begin = chunks_.begin(c), end = chunks_.end(c);
        for (std::size_t i = 0; i < inner; ++i) {
            const auto entries = gradient_stencil_.of(i);
            by_registers(begin, end, [&](std::size_t k, auto registers) {
                constexpr std::size_t n = decltype(registers)::value;
                const auto slope = apply<n, 2>(entries, phi_, k);
                for (std::size_t v = 0; v < n; ++v) {
                    const std::size_t at = k + v * lane_count;
                    store(u_.x[i] + at, load(star_.x[i] + at) - axial_.first(phi_[i] + at) + kick);
                    store(u_.y[i] + at, load(star_.y[i] + at) - slope.of[0][v]);
                    store(u_.z[i] + at, load(star_.z[i] + at) - slope.of[1][v]);
                }
            });
        }
        meet_wall(begin, end);
        Lanes flux{};
        for (std::size_t i = 0; i < section_.size(); ++i) {
            Lanes sum{};
            for (std::size_t k = begin; k < end; k += lane_count) sum += load(u_.x[i] + k);
            flux += section_.area(i) * sum;
            u_.x.wrap(i, begin, end);
            u_.y.wrap(i, begin, end);
            u_.z.wrap(i, begin, end);
        }
        of_chunk_[c] = sum(flux);
    });
    if (drive_.pressure_gradient) return 0;
    const Real flow = total(of_chunk_);
    const Real rest =
        (drive_.bulk_velocity * bore_area_ - flow / static_cast<Real>(stations())) / interior_area_;
    parallel_for(chunks_.count(), numerics_.threads, [&](std::size_t c) {
        const std::size_t begin = chunks_.begin(c), end = chunks_.end(c);
        for (std::size_t i = 0; i < inner; ++i) {
            for (std::size_t k = begin; k < end; k += lane_count)
                store(u_.x[i] + k, load(u_.x[i] + k) + rest);
            u_.x.wrap(i, begin, end);
        }
    });
    return rest;
}

/// Velocity on the wall: none in laminar flow.
void Liquid::meet_wall(std::size_t begin, std::size_t end) {
    if (flow_ == Flow::turbulent)
        wall_law_.slip(section_, begin, end, {u_, friction_velocity_, drag_});
}

/// Force of the walls on the inner nodes over density and length, mean over the stations [m3/s2]:
/// in turbulent flow that of the wall law, in laminar flow what the viscous terms come to.
Real Liquid::mean_drag() const {
    if (flow_ == Flow::laminar) return mean(viscous_force_);
    return interior_area_ / bore_area_ * mean(drag_);
}

Real Liquid::residual_divergence() {
    if (loaded_) {
        find_volume_flux(*loaded_, star_);
        find_divergence(star_, strain_);
    } else {
        find_divergence(u_, strain_);
    }
    std::vector<Real> fastest(chunks_.count());
    parallel_for(chunks_.count(), numerics_.threads, [&](std::size_t c) {
        Lanes square{}, most{};
        for (std::size_t i = 0; i < section_.interior_count(); ++i) {
            for (std::size_t k = chunks_.begin(c); k < chunks_.end(c); k += lane_count) {
                const Lanes divergence = load(strain_[i] + k);
                square += divergence * divergence;
                most = max(most, max(abs(load(u_.x[i] + k)),
                                     max(abs(load(u_.y[i] + k)), abs(load(u_.z[i] + k)))));
            }
        }
        of_chunk_[c] = sum(square);
        fastest[c] = largest(most);
    });
    const Real speed = *std::ranges::max_element(fastest);
    if (speed == 0) return 0;
    const auto count = static_cast<Real>(section_.interior_count() * stations());
    return std::sqrt(total(of_chunk_) / count) * section_.spacing() / speed;
}

} // namespace mpsdem::mps::eulerian
