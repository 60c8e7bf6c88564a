// odeint.cc - Boost.Odeint: its symplectic methods by a fixed step, its others by a tolerance.
#include "bench.h"

#include <boost/numeric/odeint.hpp>
#include <boost/version.hpp>
#include <utility>
#include <vector>

namespace odeint = boost::numeric::odeint;
using vec = std::vector<double>;

namespace {

struct out_of_time {};

struct odeint_run {
  problem *p;
  double knob;
  bool (*solve)(const odeint_run &r, double *z);
};

// ---- q'' = a(q)

struct acceleration {
  problem *p;
  void operator()(const vec &q, vec &a) const {
    if (!accelerate(p, q.data(), a.data())) throw out_of_time();
  }
  void operator()(const vec &q, const vec &, vec &a, double) const { (*this)(q, a); }
};

using pair = std::pair<vec, vec>;

pair start_pair(const problem *p) {
  return {vec(p->start, p->start + p->n), vec(p->start + p->n, p->start + 2 * p->n)};
}

template <class Stepper> bool by_steps(const odeint_run &r, double *z) {
  pair s = start_pair(r.p);
  const auto steps = static_cast<std::size_t>(r.knob);
  odeint::integrate_n_steps(Stepper(), acceleration{r.p}, s, 0.0, r.p->T / r.knob, steps);
  std::copy(s.first.begin(), s.first.end(), z);
  std::copy(s.second.begin(), s.second.end(), z + r.p->n);
  return true;
}

// ---- y' = f(y)

struct derivative {
  problem *p;
  void operator()(const vec &y, vec &dy, double) const {
    if (!differentiate(p, y.data(), dy.data())) throw out_of_time();
  }
};

const double first_step = 1e-3;

template <class Stepper> bool adaptively(Stepper stepper, const odeint_run &r, double *z) {
  vec y(r.p->start, r.p->start + 2 * r.p->n);
  odeint::integrate_adaptive(stepper, derivative{r.p}, y, 0.0, r.p->T, first_step);
  std::copy(y.begin(), y.end(), z);
  return true;
}

template <class Stepper> bool controlled(const odeint_run &r, double *z) {
  return adaptively(odeint::make_controlled(r.knob, 0.0, Stepper()), r, z);
}

bool extrapolated(const odeint_run &r, double *z) {
  return adaptively(odeint::bulirsch_stoer<vec>(r.knob, 0.0), r, z);
}

// ---- Methods

struct row {
  const char *name;
  bool by_tolerance;
  bool (*solve)(const odeint_run &r, double *z);
};

const row rows[] = {
    {"symplectic_euler", false, by_steps<odeint::symplectic_euler<vec>>},
    {"velocity_verlet", false, by_steps<odeint::velocity_verlet<vec>>},
    {"sb3a_mclachlan", false, by_steps<odeint::symplectic_rkn_sb3a_mclachlan<vec>>},
    {"dopri5", true, controlled<odeint::runge_kutta_dopri5<vec>>},
    {"fehlberg78", true, controlled<odeint::runge_kutta_fehlberg78<vec>>},
    {"bulirsch_stoer", true, extrapolated},
};

void *open_odeint(const method *self, problem *p, double knob) {
  return new odeint_run{p, knob, static_cast<const row *>(self->row)->solve};
}

bool run_odeint(void *object, double *z) {
  const auto *r = static_cast<const odeint_run *>(object);
  try {
    return r->solve(*r, z);
  } catch (const out_of_time &) {
  } catch (const std::exception &) { // Odeint's own, when steps become too small
  }
  return false;
}

void close_odeint(void *object) { delete static_cast<odeint_run *>(object); }

} // namespace

size_t odeint_methods(method *list) {
  size_t n = 0;
  for (const row &r : rows)
    list[n++] = {"Odeint",    r.name,     r.by_tolerance, &r,
                 open_odeint, run_odeint, close_odeint,   false};
  return n;
}

const char *odeint_version() { return BOOST_LIB_VERSION; }
