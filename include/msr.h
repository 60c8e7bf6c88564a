/* msr.h - libmsr: mass-spring systems in two dimensions.
 *
 *     picture + conf -> scene -> plan -> state -> frames
 *
 * A scene says what there is, a plan is a scene compiled once, a state is what moves, and a sink
 * takes the frames. Forces and integrators are const structs passed by address: one of your own
 * is used exactly as those of the library are. A whole run is
 *
 *     msr_scene_load, msr_plan_create, msr_state_create, msr_frames_open, msr_run, msr_sink_close
 *
 * World: x to the right, y up, one unit is one pixel [px], time in seconds [s]; masses, and with
 * them forces, are in the unit that the conf uses, written [kg] here. Pixel (column c, row r from
 * the top) of a picture of H rows has its centre at (c + 0.5, H - r - 0.5).
 *
 * Errors: what can fail returns a msr_status and fills `err` (may be NULL) with a sentence for the
 * user; on failure nothing is created and outputs are untouched, but for a state whose step failed,
 * which is where that step left it. What allocates may also return MSR_ENOMEM, whether or not it is
 * listed. The library never prints, never exits and installs no handler. Who creates frees; freeing
 * NULL does nothing.
 *
 * Threads: there is no global state. A scene, a state, a renderer or a sink belongs to one thread
 * at a time; a plan is immutable and may be shared by any number of states in any number of
 * threads. The library begins threads of its own only where it's told to: for
 * msr_run_options.threads until msr_run returns, for msr_plan_options.threads until msr_state_free;
 * they take no signals.
 *
 * Option structs are valid when all zero: zero means the default that their fields state.
 */
#ifndef MSR_H
#define MSR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define MSR_API __attribute__((visibility("default")))
#else
#define MSR_API
#endif

#define MSR_VERSION "0.2.0"

/* Version of the library that the program runs with, as MSR_VERSION. */
MSR_API const char *msr_version(void);

/* ---- Errors ---------------------------------------------------------------------------------- */

#define MSR_STATUSES(X)                                                                            \
  X(MSR_OK, "success")                                                                             \
  X(MSR_EIO, "input or output failed")                                                             \
  X(MSR_ENOMEM, "out of memory")                                                                   \
  X(MSR_EUSAGE, "wrong argument")                                                                  \
  X(MSR_EINPUT, "bad picture, conf or scene")                                                      \
  X(MSR_EUNSTABLE, "the simulation became unstable")                                               \
  X(MSR_EINTR, "interrupted") /* for callbacks: the library never makes it */

#define MSR_STATUS_NAME(name, text) name,
typedef enum msr_status { MSR_STATUSES(MSR_STATUS_NAME) } msr_status;
#undef MSR_STATUS_NAME

enum { MSR_MESSAGE_SIZE = 512 };

/* What went wrong. For a file: `file:line:column: what; what to do`. */
typedef struct msr_error {
  msr_status status;
  char message[MSR_MESSAGE_SIZE]; /* one line, UTF-8, no newline at the end */
} msr_error;

/* The text of a status, as in MSR_STATUSES. */
MSR_API const char *msr_status_text(msr_status status);

/* ---- Pictures and confs ---------------------------------------------------------------------- */

/* Colours of a picture, 8 bits a channel, rows from the top. */
typedef struct msr_picture {
  size_t width, height;
  unsigned char *rgb; /* [height][width][3] */
} msr_picture;

/* A white picture. MSR_ENOMEM; MSR_EUSAGE if a side is 0 or the size overflows. */
MSR_API msr_status msr_picture_create(size_t width, size_t height, msr_picture **picture,
                                      msr_error *err);

/* Reads the first image of a PPM file, P3 or P6, maxval 1..65535 (scaled to 0..255, rounded).
 * `more` (may be NULL) tells whether other images follow it.
 * MSR_EIO if the file can't be read, MSR_EINPUT if it's no sound PPM. */
MSR_API msr_status msr_picture_read(const char *path, msr_picture **picture, bool *more,
                                    msr_error *err);

/* The same from `size` bytes in memory; `name` stands for the file in messages. */
MSR_API msr_status msr_picture_parse(const char *name, const void *bytes, size_t size,
                                     msr_picture **picture, bool *more, msr_error *err);

/* Writes a P6 file, maxval 255. As all files that the library writes it appears whole or not at
 * all; pipes, devices and "-", standard output, are written directly. MSR_EIO. */
MSR_API msr_status msr_picture_write(const msr_picture *picture, const char *path, msr_error *err);

MSR_API void msr_picture_free(msr_picture *picture);

/* What a `.conf` says. */
typedef struct msr_conf {
  double dt;           /* DT: duration of an iteration [s], > 0 */
  double gravity;      /* GRAVITE: acceleration along -y [px/s^2], any sign */
  double mass;         /* MASSE: of each coloured pixel [kg], > 0 */
  double stiffness;    /* TENSION_RESSORT: k of each spring [kg/s^2], >= 0 */
  uint64_t iterations; /* NB_ITERATIONS: of DT each, <= 2^53 */
  uint64_t images;     /* NB_IMAGES: frames, 1 .. 10^9, at most one per iteration (1 if none) */
} msr_conf;

/* Reads a conf: the six names above in that order, each followed by its value on the next line;
 * blank lines, `#` comments, trailing spaces and CRLF are allowed. MSR_EIO, MSR_EINPUT. */
MSR_API msr_status msr_conf_read(const char *path, msr_conf *conf, msr_error *err);

/* The same from `size` bytes in memory; `name` stands for the file in messages. */
MSR_API msr_status msr_conf_parse(const char *name, const char *text, size_t size, msr_conf *conf,
                                  msr_error *err);

/* ---- What forces see ------------------------------------------------------------------------- */

/* Springs first+s -- first+s+offset, s = 0 .. count-1, offset > 0: a row of a lattice is one run.
 * Spring s has stiffness k[s*stride] [kg/s^2] and rest length L[s*stride] [px]. */
typedef struct msr_run_of_springs {
  size_t first, count, offset;
  const double *k, *L;
  size_t stride; /* 0: one k and one L for the whole run; 1: k[count], L[count] */
} msr_run_of_springs;

/* A spring from mass i to the fixed point (x, y) [px]. */
typedef struct msr_anchor {
  size_t i;
  double x, y, k, L;
} msr_anchor;

/* All springs of a scene. */
typedef struct msr_springs {
  size_t n, n_runs, n_anchors;   /* n: springs in all runs */
  const msr_run_of_springs *run; /* [n_runs] */
  const msr_anchor *anchor;      /* [n_anchors] */
} msr_springs;

/* The n masses of a scene at time t, for reading. */
typedef struct msr_view {
  size_t n;
  double t;              /* [s] */
  const double *x, *y;   /* [n] [px] */
  const double *vx, *vy; /* [n] [px/s]; may be NULL in add() of a force that doesn't use velocity */
  const double *m;       /* mass i is m[i*m_stride] [kg] */
  size_t m_stride;       /* 0: all masses are equal; 1: m[n] */
  const msr_springs *springs;
} msr_view;

/* Mass i [kg]. */
static inline double msr_view_mass(const msr_view *s, size_t i) { return s->m[i * s->m_stride]; }

/* ---- Forces ---------------------------------------------------------------------------------- */

/* What a call on all masses takes: so many operations (+ - * / and roots of doubles) and so many
 * bytes of arrays (each element once for reading, once for writing) for itself, for each mass and
 * for each spring. All 0: nobody knows. */
typedef struct msr_load {
  double call, mass, spring;                   /* operations */
  double call_bytes, mass_bytes, spring_bytes; /* bytes */
} msr_load;

/* A kind of force. Only name, summary and add are required; NULL, false and 0 do for the rest, but
 * conservative goes with energy, both or neither.
 * A callback's status other than MSR_OK ends what called it and comes back unchanged; one that is
 * given err may say why.
 * Each may be called from several threads at once, with different scratch. */
typedef struct msr_force {
  const char *name;    /* one word */
  const char *summary; /* one line: the formula */
  const char *absent;  /* why a scene may do without: "GRAVITE is 0" (NULL: "not asked for") */
  bool conservative;   /* energy() is its potential: F = -grad U */
  bool dissipative;    /* F.v <= 0 always: it can only take energy away */
  bool uses_velocity;  /* F depends on v */
  bool uses_time;      /* F depends on t */
  bool ignores_start;  /* idle, describe, prepare and rates never read x, y, vx and vy of s, which
                        * may be NULL there: a plan then needs no room for them */
  size_t params_size;  /* bytes that msr_scene_add_force copies */
  size_t scratch_size; /* bytes of memory of its own in each state, zeroed at first: caches */

  /* Are these parameters valid? */
  msr_status (*check)(const void *params, msr_error *err);
  /* Would it do nothing on this scene? Then the plan leaves it out. `s` is the scene at the start;
   * the reason goes to `why`, one line. */
  bool (*idle)(const void *params, const msr_view *s, char *why, size_t size);
  /* Why it's on, one line, from its parameters: "DRAG = 0.1 kg/s". */
  void (*describe)(const void *params, const msr_view *s, char *text, size_t size);
  /* Compiles the parameters for the scene `s` at its start. NULL: `self` is the params. */
  msr_status (*prepare)(const void *params, const msr_view *s, void **self, msr_error *err);
  void (*release)(void *self); /* frees what prepare made */

  /* Adds the force on each mass to fx, fy [n] [kg px/s^2]. */
  msr_status (*add)(const void *self, void *scratch, const msr_view *s, double *fx, double *fy);
  /* For uses_velocity: advances vx, vy [n] by h [s] under this force alone, positions and s->t
   * held, exactly if it can (no limit of stability then); `backward` asks for the adjoint order
   * of its parts. NULL: the library takes an explicit midpoint step of add(). */
  msr_status (*flow)(const void *self, void *scratch, const msr_view *s, double h, bool backward,
                     double *vx, double *vy);
  /* Potential energy [kg px^2/s^2]. */
  double (*energy)(const void *self, const msr_view *s);
  /* For conservative: adds the discrete gradient between the places of s and those of `to`, whose
   * work is what the potential loses: F.(to - s) = U(s) - U(to). NULL: the library corrects add()
   * at the middle, along the way of all masses, to the same end (Gonzalez 1996, J. Nonlinear Sci.
   * 6, 449); momentum is kept only by a force that gives its own. */
  msr_status (*between)(const void *self, void *scratch, const msr_view *s, const msr_view *to,
                        double *fx, double *fy);
  /* Upper bounds at any stretch, for the stable step: of the largest eigenvalue of -dF/dx / m
   * [1/s^2], at v = 0, and of -dF/dv / m [1/s]; both are 0 on entry. */
  msr_status (*rates)(const void *self, const msr_view *s, double *omega2, double *gamma);
  /* For a force on which neither place nor velocity nor time has a say: adds that on a mass of
   * s->m[0] to f[2], x and y. Beside springs of a picture there may be one such force and one with
   * relax, not the same; then states of methods that split step faster, row by row. NULL: it isn't
   * such a one. */
  void (*uniform)(const void *self, const msr_view *s, double *f);
  /* For a flow that is the same for all equal masses: v = keep v + push in a time h [s], exactly as
   * flow() would; it fills push[2], x and y, and returns keep. Only t, m and n of s are given; for
   * the same t and h it may be asked once for several flows. NULL: likewise. */
  double (*relax)(const void *self, void *scratch, const msr_view *s, double h, double *push);
  /* For what drives, neither dissipative nor conservative: the most power that it can give at s->t,
   * whatever the velocities [kg px^2/s^3]; it may be called after every step. NULL: for the guard
   * the library asks add() after every step. */
  double (*power)(const void *self, void *scratch, const msr_view *s);
  msr_load add_load, flow_load; /* what add() and flow() take, where masses are equal */
} msr_force;

/* F_ij = k (|x_ij| - L) x_ij / |x_ij|, 0 at |x_ij| = 0. Every scene has it: it can't be added. */
MSR_API extern const msr_force msr_force_springs;

/* F = -m g along y; U = m g y. */
typedef struct msr_gravity {
  double g; /* [px/s^2] */
} msr_gravity;
MSR_API extern const msr_force msr_force_gravity;

/* F = -c v. */
typedef struct msr_drag {
  double c; /* [kg/s], >= 0 */
} msr_drag;
MSR_API extern const msr_force msr_force_drag;

/* Damping along the springs: F_ij = z (v_ij . n) n, n the spring's direction. */
typedef struct msr_damping {
  double z; /* [kg/s], >= 0 */
} msr_damping;
MSR_API extern const msr_force msr_force_damping;

/* Random wind, which includes the drag of the air that it moves: F = c (w(t) - v), with
 * w = (speed, 0) plus an Ornstein-Uhlenbeck process in x and one in y of standard deviation
 * `gust` and correlation time `gust_time` (Uhlenbeck & Ornstein 1930), drawn from the seed
 * on a grid of gust_time / 16 and interpolated by a spline of degree 7: a function of (seed, t)
 * alone, the same for every integrator and step. The variance is gust^2; the covariance at lags
 * above a fifth of gust_time is 5.7 % above gust^2 exp(-lag / gust_time). gust = 0 blows steadily
 * and draws nothing. */
typedef struct msr_wind {
  double c;         /* drag of the air [kg/s], > 0; 0: the mean mass over 1 s */
  double speed;     /* mean, along x [px/s], any sign */
  double gust;      /* [px/s], >= 0 */
  double gust_time; /* [s], >= 1e-6; 0: 1 s */
  uint64_t seed;
} msr_wind;
MSR_API extern const msr_force msr_force_wind;

/* A constant force on one mass; U = -F.(x - x0). */
typedef struct msr_push {
  size_t mass;
  double fx, fy; /* [kg px/s^2] */
} msr_push;
MSR_API extern const msr_force msr_force_push;

/* All of the above, then NULL. */
MSR_API extern const msr_force *const msr_forces[];

/* ---- Integrators ----------------------------------------------------------------------------- */

/* The problem that an integrator solves: q'' = a(t, q, v) in n coordinates.
 * For a scene of N masses n = 2N, q = x[N], y[N] and v = vx[N], vy[N]. Only n and acceleration are
 * required. */
typedef struct msr_system {
  size_t n;
  void *self;
  /* a[n] at (t, q, v). v is NULL only if damp is given: then a leaves out what depends on v. */
  msr_status (*acceleration)(void *self, double t, const double *q, const double *v, double *a);
  /* Advances v by h under what depends on v alone, q and t held; backward: in adjoint order.
   * NULL: what depends on v, if anything does, is in a, and methods that split lose their order. */
  msr_status (*damp)(void *self, double t, double h, bool backward, const double *q, double *v);
  /* q += h u, stopped by what is in the way, which reflects v; u may be v. `a` [n], the
   * acceleration at the start, bends the path: it is at q + s u + s (s - h) a / 2 after a time s,
   * and v is the velocity in its middle, to which half a kick by the acceleration at the end is
   * still to come. If a is NULL the path is straight.
   * NULL: nothing is in the way. Integrators call msr_system_drift. */
  msr_status (*drift)(void *self, double h, const double *u, const double *a, double *q, double *v);
  /* What is in the way of a step of h from (q0, v0) to (q, v): it stops q and reflects v, and
   * `met` tells whether it did. NULL: nothing is in the way. Integrators that neither drift nor
   * call it leave that to the library. */
  msr_status (*bounce)(void *self, double h, const double *q0, const double *v0, double *q,
                       double *v, bool *met);
  /* What follows is for implicit methods. */
  /* The mean acceleration from q0 to q1 whose work is exactly what the potentials lose (discrete
   * gradient), what has no potential taken at time t in the middle. NULL: a in the middle. */
  msr_status (*between)(void *self, double t, const double *q0, const double *q1, double *a);
  /* Prepares solve for A = 1 - c da/dq at (t, q) or, if q0 isn't NULL, for 1 - 2 c times the
   * derivative by q of what between gives from q0. What is near it will do (of a scene: springs and
   * anchors, made positive; other forces count as constant, which converges while c times their
   * own -da/dq is below 1); a closer one takes fewer iterations. `from`, near q, is where the
   * iteration was before, or begins: to take tensions as they would be if they had changed linearly
   * since lets it converge in as few where springs are stiff. Of coordinates that are held [n]
   * (NULL: none is) the rows and columns of A are those of 1. */
  msr_status (*linearise)(void *self, double t, const double *q0, const double *from,
                          const double *q, double c, const bool *held);
  /* x[n] with |A x - r| <= tolerance |x|, or as near as rounding allows. Both NULL: implicit
   * methods take differences of a. */
  msr_status (*solve)(void *self, const double *r, double tolerance, double *x);
  /* Marks in held [n] the coordinates that something in the way stops between q0 and q, beside
   * those that are marked, which don't move; `more` tells whether it marked any: the step is then
   * solved again, so that each time one at least must be new. A coordinate that is held does no
   * work and has its velocity reversed, by a step of energy-momentum, so that the energy is kept
   * through elastic impacts at any step. NULL: nothing is in the way. */
  msr_status (*hold)(void *self, const double *q0, const double *q, bool *held, bool *more);
  /* What impacts that aren't elastic make of v after a step in which coordinates were held; push
   * [n] is the change of velocity that holding each of them took. NULL: nothing. */
  msr_status (*rebound)(void *self, const bool *held, const double *push, double *v);
  /* Adaptive methods take a step back if its estimated error is larger than atol + rtol |q| in q,
   * or atol + rtol |v| in v with times in seconds, |.| being the largest coordinate. An rtol of 10
   * DBL_EPSILON, for rounding, is the least, whatever is asked for. Both finite, 0 or more, or
   * MSR_EUSAGE; both 0: atol 1e-6. */
  double atol, rtol;
} msr_system;

/* q += h u along a path bent by a, past what is in the way if there is anything. What drift
 * returns. */
static inline msr_status msr_system_drift(const msr_system *system, double h, const double *u,
                                          const double *a, double *q, double *v) {
  if (system->drift) return system->drift(system->self, h, u, a, q, v);
  for (size_t i = 0; i < system->n; i++) q[i] += h * u[i];
  return MSR_OK;
}

/* One step in time: from t to end; h is their difference before rounding. */
typedef struct msr_interval {
  double t, h, end;
} msr_interval;

/* The time at a share c of an interval, for stages; at 1 exactly its end, where the next begins. */
static inline double msr_interval_time(const msr_interval *interval, double c) {
  return c == 1 ? interval->end : interval->t + c * interval->h;
}

/* What a method works with, for one system. */
typedef struct msr_workspace {
  double *vector; /* [vectors][n] */
  void *object;   /* what open made */
  uint64_t steps; /* taken so far; a method that chooses its own adds them here */
} msr_workspace;

/* A method. Its declarations are what tests try to refute. Only name, summary and step are
 * required. */
typedef struct msr_integrator {
  const char *name;      /* one word */
  const char *summary;   /* one line */
  const char *reference; /* author, year, place; NULL: none */
  int order;             /* error ~ h^order at a fixed time; adaptive: of its own steps, the highest
                          * there is */
  int damped_order;      /* the same where a force depends on v; 0: order */
  bool symplectic;       /* keeps phase-space area, where a is a gradient and v isn't used */
  bool reversible;       /* flipping v retraces the path, likewise, where no support is met */
  bool conservative;     /* keeps the energy for any h, likewise */
  bool splits;           /* advances what depends on v by damp(), not through a */
  bool bounces;          /* sees to what is in the way itself: moves q by msr_system_drift alone
                          * (nor does it put it back: how far q went is remembered), or calls
                          * bounce(); else the library does after each step, and it does
                          * where impacts are located and the method is adaptive */
  bool holds;            /* calls hold(), where the system has it, instead */
  bool implicit;         /* solves equations: evaluations are as many as that takes */
  bool adaptive;         /* chooses its own steps within the interval, by atol and rtol */
  bool remembers;        /* more than (t, q, v): a copy of the state or a saved one begins anew, and
                          * goes on with other bits */
  double evaluations;    /* of a, per step; 0: as many as it takes */
  double stability;      /* largest stable h*omega for q'' = -omega^2 q; 0: none, INFINITY: all, as
                          * of what is adaptive */
  double damping_stability; /* largest stable h*gamma for v' = -gamma v: through damp() if it
                             * splits, else through a; 0: none is */
  size_t vectors;           /* of n doubles of workspace */
  /* Memory of its own beside the vectors; NULL: none. MSR_ENOMEM; MSR_EUSAGE if the system is too
   * large for it. */
  msr_status (*open)(const struct msr_integrator *self, const msr_system *system, void **object,
                     msr_error *err);
  void (*close)(void *object);
  /* Makes the workspace fit (t, q, v): called before the first step and whenever they have been
   * changed from outside. NULL: no need. */
  msr_status (*begin)(const struct msr_integrator *self, const msr_system *system, double t,
                      const double *q, const double *v, msr_workspace *work);
  /* Advances q and v over the interval. MSR_EUNSTABLE if its equations can't be solved. */
  msr_status (*step)(const struct msr_integrator *self, const msr_system *system,
                     const msr_interval *interval, double *q, double *v, msr_workspace *work,
                     msr_error *err);
  const void *coefficients; /* of the family's row */
} msr_integrator;

MSR_API extern const msr_integrator msr_integrator_euler;            /* explicit; for contrast */
MSR_API extern const msr_integrator msr_integrator_symplectic_euler; /* the assignment's steps */
MSR_API extern const msr_integrator msr_integrator_verlet;
MSR_API extern const msr_integrator msr_integrator_pefrl;
MSR_API extern const msr_integrator msr_integrator_srkn4;
MSR_API extern const msr_integrator msr_integrator_srkn6;
MSR_API extern const msr_integrator msr_integrator_kahan_li_6;
MSR_API extern const msr_integrator msr_integrator_kahan_li_8;
MSR_API extern const msr_integrator msr_integrator_rk4;

/* Adaptive, explicit, by GSL (odeiv2). After a second errors are of about atol, rk8pd's a tenth of
 * it; through supports they are those of the rule of impact and of the steps taken.
 * MSR_EUNSTABLE where a isn't finite or no step is small enough, and after 10^7 tries in a step;
 * q and v are then as before. GSL's memory isn't in msr_plan_figures: of rkf45 and rkck 8 times
 * that of x, y, vx and vy [masses], of rk8pd 15, of msadams 33 times. Where it's lacking,
 * MSR_ENOMEM; but if another thread takes what was left in that very moment, GSL's handler of
 * errors is called, which unless the program has set one ends it. */
MSR_API extern const msr_integrator msr_integrator_rkf45;
MSR_API extern const msr_integrator msr_integrator_rkck;
MSR_API extern const msr_integrator msr_integrator_rk8pd;
MSR_API extern const msr_integrator msr_integrator_msadams;

/* Implicit, stable at any step where forces are linear. Each stage is solved to rounding by
 * Newton's method, with the system's linearise and solve or, without them, by differences of a
 * (BiCGSTAB; van der Vorst 1992). Memory: 7 vectors of n doubles, of sdirk2 8,
 * of energy-momentum 9; without solve, 7
 * more; on a scene, the matrix of its springs, which msr_plan_figures counts. What depends on v
 * acts by damp(), for half a step at each end. MSR_EUNSTABLE if a stage isn't solved in 200
 * iterations, or isn't finite; on a scene of 2^32 - 1 masses or springs or more, msr_plan_create
 * returns MSR_EUSAGE. energy-momentum keeps the energy only if the system has between(), as a scene
 * has; else it is the implicit midpoint rule. */
MSR_API extern const msr_integrator msr_integrator_backward_euler;
MSR_API extern const msr_integrator msr_integrator_implicit_midpoint;
MSR_API extern const msr_integrator msr_integrator_sdirk2;
MSR_API extern const msr_integrator msr_integrator_energy_momentum;

/* All of the above, then NULL. */
MSR_API extern const msr_integrator *const msr_integrators[];

/* Steps any system, scene or none: q and v [system->n] from time t by `steps` steps of h, which may
 * be negative. Explicit methods don't look at the result, which isn't finite if a isn't or h is far
 * too large. MSR_EUSAGE if t or h isn't finite, MSR_ENOMEM, what the integrator finds wrong, or
 * what the system's callbacks return. */
MSR_API msr_status msr_integrate(const msr_integrator *integrator, const msr_system *system,
                                 double t, double h, uint64_t steps, double *q, double *v,
                                 msr_error *err);

/* ---- Scene: what there is -------------------------------------------------------------------- */

typedef struct msr_scene msr_scene;

typedef struct msr_scene_options {
  int neighbours;     /* springs to 4 or 8 neighbours; 0: 4 */
  bool attach;        /* a mass beside a support is tied to it by a spring */
  bool closed_border; /* the picture's border is a support; else masses may leave */
} msr_scene_options;

/* A scene with no picture and no mass: gravity 0, DT 0.005 s, one iteration, one image. */
MSR_API msr_status msr_scene_create(msr_scene **scene, msr_error *err);

/* A scene from a picture (copied) and a conf: one mass per coloured pixel, in reading order,
 * springs between neighbours, each with its length in the picture as L; black pixels are supports;
 * gravity if conf->gravity isn't 0. `options` may be NULL. `name` stands for the picture in
 * messages. MSR_EINPUT for a pixel that is grey or pale (white is 255,255,255, black 0,0,0, and a
 * mass has channels that differ by 64 or more) or a value of the conf out of its range;
 * MSR_EUSAGE for options out of range; MSR_ENOMEM. */
MSR_API msr_status msr_scene_from_picture(const char *name, const msr_picture *picture,
                                          const msr_conf *conf, const msr_scene_options *options,
                                          msr_scene **scene, msr_error *err);

/* The same from two files, `.ppm` and `.conf`. MSR_EIO if one can't be read, and as above. */
MSR_API msr_status msr_scene_load(const char *picture_path, const char *conf_path,
                                  const msr_scene_options *options, msr_scene **scene,
                                  msr_error *err);

MSR_API void msr_scene_free(msr_scene *scene);

/* The i-th thing that a user should know about the scene, one line, or NULL past the last. */
MSR_API const char *msr_scene_warning(const msr_scene *scene, size_t i);

/* Sets DT [s], the number of iterations and of images, in the ranges of msr_conf. MSR_EINPUT. */
MSR_API msr_status msr_scene_set_times(msr_scene *scene, double dt, uint64_t iterations,
                                       uint64_t images, msr_error *err);

/* Supports: a mass that meets one comes back with `restitution` (0..1, 1 at first) of its normal
 * speed; Coulomb friction `friction` (>= 0, 0 at first) acts along it. With a restitution below 1 a
 * mass rests, and has no normal velocity, where forces (those that don't depend on v) press it on
 * the support and would bring it back within two steps; friction of up to its coefficient times the
 * pressure then holds it where it is. MSR_EUSAGE. */
MSR_API msr_status msr_scene_set_contact(msr_scene *scene, double restitution, double friction,
                                         msr_error *err);

/* Collisions: masses are discs of this diameter [px] (0, as at first: points that never meet).
 * Pairs that a spring ties pass through each other; no other pair ever does, at any speed. They
 * come back with the restitution of msr_scene_set_contact and without friction: impulses act along
 * the line between the centres, so that momentum is kept to rounding, angular momentum too where
 * two collide and to the order of the step where more do at once, and energy is never made. Who is
 * closer to another at the start is moved apart from it, slowly, the centre of mass staying where
 * it is; but not from masses of its own body that are all so close, from one to the next along the
 * springs: such pairs count as tied. Supports are met by the centre. With a restitution below 1
 * contacts slower than about what a step's forces change velocities by end without a relative
 * velocity: what lies on each other rests. Order 1 through a collision, with either rule of
 * msr_impacts; with MSR_IMPACTS_LOCATED methods other than Verlet and symplectic Euler then end no
 * step at an impact. Where more meet in one step than passes can put right (or more than 8 * masses
 * + 4096 pairs: diameters of several times the distances, many masses at one place) those that
 * meet, at worst all masses, go together for that step: nobody comes nearer to anybody then,
 * either; such steps take long. MSR_EUSAGE; msr_plan_create returns it if dozens of masses of one
 * body are closer to each other than the diameter. */
MSR_API msr_status msr_scene_set_collisions(msr_scene *scene, double diameter, msr_error *err);

typedef struct msr_mass {
  double x, y;   /* [px] */
  double vx, vy; /* [px/s] */
  double m;      /* [kg], > 0 */
  unsigned char rgb[3];
} msr_mass;

/* Adds a mass after all others; its number goes to `index` (may be NULL).
 * MSR_EUSAGE if a value isn't finite, m <= 0 or it is inside a support (beyond a closed border,
 * too); MSR_ENOMEM. */
MSR_API msr_status msr_scene_add_mass(msr_scene *scene, const msr_mass *mass, size_t *index,
                                      msr_error *err);

/* Adds a spring between masses i and j of stiffness k >= 0 [kg/s^2] and rest length L >= 0 [px].
 * MSR_EUSAGE, MSR_ENOMEM. */
MSR_API msr_status msr_scene_add_spring(msr_scene *scene, size_t i, size_t j, double k, double L,
                                        msr_error *err);

/* Adds a spring between a mass and a fixed point. MSR_EUSAGE, MSR_ENOMEM. */
MSR_API msr_status msr_scene_add_anchor(msr_scene *scene, const msr_anchor *anchor, msr_error *err);

/* Adds a force, built-in or one's own; the force must outlive the scene and its plans, while
 * params [force->params_size] (NULL if that is 0) are copied. Forces act in the order in which they
 * were added; adding a kind twice adds it twice.
 * What force->check says, MSR_EUSAGE, MSR_ENOMEM. */
MSR_API msr_status msr_scene_add_force(msr_scene *scene, const msr_force *force, const void *params,
                                       msr_error *err);

/* Number of masses so far. */
MSR_API size_t msr_scene_masses(const msr_scene *scene);

/* The mass of a pixel of the picture. MSR_EUSAGE if there is none there. */
MSR_API msr_status msr_scene_mass_at(const msr_scene *scene, size_t column, size_t row,
                                     size_t *index, msr_error *err);

/* ---- Plan: a scene compiled ------------------------------------------------------------------ */

typedef struct msr_plan msr_plan;

/* How a mass meets a support. Located, methods keep their order through isolated bounces: Verlet as
 * it follows the path that the acceleration bends, the others as they end a step at each impact and
 * begin another there, in a few tries. Where masses rest or come back within 4 steps, or more than
 * 4 meet something one after the other in a step, those others have order 2 at best, 1 if forces
 * depend on v. */
typedef enum msr_impacts {
  MSR_IMPACTS_KEPT,   /* it keeps its old place for the step, and its velocity is reflected: order 1
                       * through a bounce; by safe steps elastic impacts don't heat */
  MSR_IMPACTS_LOCATED /* it is reflected when its path meets the support; by safe steps elastic
                       * impacts heat by little, above them by more than with the other rule */
} msr_impacts;

typedef struct msr_plan_options {
  const msr_integrator *integrator; /* NULL: Verlet and, if substeps is 0 and an iteration takes
                                     * hundreds, steps of energy-momentum as long as many substeps
                                     * wherever they cost less; tries that fail add a quarter of the
                                     * substeps' cost at most, in counted work; and from where
                                     * energy comes from nowhere on, see msr_state_step. With
                                     * located impacts, only where nothing can be hit; never with
                                     * collisions */
  uint64_t substeps; /* steps per iteration; 0: as many as keep below the safe step */
  double atol, rtol; /* of adaptive methods, as in msr_system: the error of a step is up to
                      * atol + rtol |q| [px] in x and y and atol + rtol |v| [px/s] in vx and vy; an
                      * error of v shakes a stiff spring little and often, so that a second of any
                      * scene ends within some atol [px]; both 0: atol 1e-6 */
  msr_impacts impacts;
  unsigned threads; /* that a state may step with, up to 256; 0: 1. Each state starts its own, which
                     * end with it, as many of them as figures.threads tells. Bits don't depend on
                     * them */
  bool
      timed; /* states measure the time of each effect (msr_state_seconds); else no clock is read */
} msr_plan_options;

/* Compiles the scene, which may be freed after; the integrator must outlive the plan. `options` may
 * be NULL. MSR_EUSAGE if the integrator lacks name, summary or step, or a tolerance isn't finite or
 * is negative, or if the integrator is implicit and there are 2^32 - 1 masses or springs or more;
 * or for more than 256 threads; MSR_EINPUT if no number of substeps is enough; MSR_ENOMEM; or what
 * force->prepare or force->rates returns. */
MSR_API msr_status msr_plan_create(const msr_scene *scene, const msr_plan_options *options,
                                   msr_plan **plan, msr_error *err);

MSR_API void msr_plan_free(msr_plan *plan);

/* The i-th thing that a user should know about the plan, or NULL past the last. */
MSR_API const char *msr_plan_warning(const msr_plan *plan, size_t i);

/* What is done about an effect. */
typedef enum msr_role {
  MSR_ROLE_FORCE,   /* a force acts */
  MSR_ROLE_CONTACT, /* supports, border, collisions: something may be in the way */
  MSR_ROLE_STEP     /* integrator, leaps: steps in time; guard, care: what watches over them */
} msr_role;

/* What an effect that is on takes in a step, as the plan knows it without taking one: operations
 * (+ - * / and roots of doubles) and bytes of arrays that are read and written, in cache or in
 * memory, as in msr_load, per mass, over all calls of the step. NAN: as many as it takes. Of an
 * effect that is off all are 0. */
typedef struct msr_cost {
  double calls; /* on all masses; below 1: not at every step */
  double operations, bytes;
  bool at_least; /* more where something is met */
} msr_cost;

/* Something that a scene may call for, and what it takes. */
typedef struct msr_effect {
  const char *name;
  bool on;
  const char *reason;     /* what called for it, or what is missing; owned by the plan */
  const msr_force *force; /* NULL: it is none */
  msr_role role;
  msr_cost cost;
} msr_effect;

/* Every effect: first those that are on, in the order in which they act, forces, contacts, then
 * what steps and watches; then those that are off. Their number goes to `n`. */
MSR_API const msr_effect *msr_plan_effects(const msr_plan *plan, size_t *n);

/* The figures of a plan. */
typedef struct msr_plan_figures {
  size_t masses, springs, anchors;
  size_t width, height; /* of the picture [px]; 0: the scene has none */
  size_t supports;      /* black pixels */
  const msr_integrator *integrator;
  const msr_integrator *leaps; /* takes long steps where they cost less than substeps; NULL: none */
  const msr_integrator *care;  /* takes over, from where the energy was sound, once 2 % of what the
                                * scene had to give came from nowhere; NULL: none */
  msr_impacts impacts;
  unsigned threads; /* that a state steps with: of those asked for no more than there are processors
                     * for the process, nor than have an object of their own to step or a part of a
                     * large one */
  const char *by_vectors; /* why states step vectors of all masses, one effect after the other, by
                           * one thread; NULL: they step row by row, several steps at a time, as
                           * methods that split do past a picture's objects or a program's equal
                           * masses, with springs, gravity and air. Owned by the plan */
  uint64_t iterations, images, substeps;
  double atol, rtol;  /* of adaptive methods */
  double dt;          /* of an iteration [s] */
  double h;           /* of a step: dt / substeps [s] */
  double stable_step; /* steps below this are stable at any stretch [s]; 0: none; may be INFINITY */
  double safe_step;   /* the library's own steps are no larger: 0.9 of it; where supports may be hit
                       * 0.5, or with `care` 0.42 if nothing takes or brings energy; without `care`
                       * down to 1/16 where a fall can crush springs, m g H > 0.15 k L^2, and 1/128
                       * where what moves or is compressed at the start can;
                       * of implicit methods there, and of symplectic ones, the same of 2 / omega */
  double omega;       /* bound of the angular frequencies, at any stretch [1/s] (Gershgorin) */
  double gamma;       /* bound of the rates of damping that limit the step [1/s] */
  size_t plan_bytes, state_bytes; /* of memory; the picture, 3 bytes a pixel, counts as the plan's
                                   * though its scene and other plans of it share it; what a state
                                   * allocates once steps of `care` begin, as much as implicit
                                   * methods take, isn't counted */
} msr_plan_figures;
MSR_API msr_plan_figures msr_plan_describe(const msr_plan *plan);

/* How a largest stable step was found. */
typedef enum msr_found {
  MSR_FOUND_ANY,         /* any step is stable: nothing swings, or the method has no limit */
  MSR_FOUND_NONE,        /* no step is */
  MSR_FOUND_CLOSED_FORM, /* a whole rectangle of 4 neighbours: sum of (4 k/m) sin^2((n-1) pi/2n) */
  MSR_FOUND_LANCZOS,     /* largest eigenvalue of the actual mesh, 0.1 % accurate (Lanczos 1950) */
  MSR_FOUND_BOUND        /* at least so large: by bounds that forces give (Gershgorin) or, of more
                          * than 131072 masses of a picture, those of a lattice without end: omega^2
                          * = 4 k/m (at rest) and 8 k/m (stretched), with 8 neighbours 8 and 12 */
} msr_found;

/* A largest stable step. */
typedef struct msr_limit {
  double step;  /* [s]; 0: none; INFINITY: any */
  double omega; /* the largest angular frequency [1/s] */
  msr_found found;
  int iterations; /* of Lanczos; else 0 */
} msr_limit;

/* The largest steps that are stable for the plan's integrator, contacts apart. Forces other than
 * springs and anchors, if they have rates, count by these. */
typedef struct msr_stability {
  msr_limit at_rest;   /* for small swings about the start, springs as long as they are there */
  msr_limit stretched; /* at any stretch: for the worst, all springs pulled without limit */
  msr_limit damped;    /* as at_rest, with all that depends on v: by one step of the method for each
                        * frequency up to the largest and its damping, which is known where drag
                        * meets equal masses, or damping equal springs at rest; else bounded */
  double bound;        /* not above any of these: stable_step of the figures, by which substeps are
                        * chosen (Gershgorin) [s] */
} msr_stability;

/* Analyses the plan: some 100 products of the matrix of springs with a vector; memory, given back:
 * 13 doubles a mass. Of more than 131072 masses it makes neither, and tells bounds of all but whole
 * rectangles without damping. MSR_ENOMEM, or what force->rates, force->add or the integrator's step
 * returns. */
MSR_API msr_status msr_plan_stability(const msr_plan *plan, msr_stability *stability,
                                      msr_error *err);

/* Iterations done at frame i: i * iterations / images, rounded down. */
MSR_API uint64_t msr_plan_frame_iteration(const msr_plan *plan, uint64_t frame);

/* The pixel of the picture where a mass began; false if it began at none. */
MSR_API bool msr_plan_pixel(const msr_plan *plan, size_t mass, size_t *column, size_t *row);

/* ---- State: what moves ----------------------------------------------------------------------- */

typedef struct msr_state msr_state;

/* The state at t = 0; the plan must outlive it. MSR_ENOMEM if there is no memory, or if the system
 * gives fewer threads than figures.threads: the message says how many it did; what the integrator's
 * open returns. */
MSR_API msr_status msr_state_create(const msr_plan *plan, msr_state **state, msr_error *err);

MSR_API void msr_state_free(msr_state *state);

/* Makes `to` what `from` is; both are of the same plan. What follows is the same, too, unless the
 * integrator remembers. */
MSR_API void msr_state_copy(msr_state *to, const msr_state *from);

/* 64-bit hash of the bits of t, x, y, vx, vy (FNV-1a over 8-byte words); the same on every machine
 * for the same bits. */
MSR_API uint64_t msr_state_hash(const msr_state *state);

/* Writes to a file and reads back x, y, vx, vy, the iterations, substeps, contacts and frames so
 * far, what the guard knows, whether care is on and what it would go back to: what follows has the
 * same bits as if it had never been saved, unless the integrator remembers. The work and the calls
 * are left out: after a load they begin at 0. The plan must have as many masses, the same DT and
 * substeps, and have chosen them by itself or not, as the one that it was saved from; on failure
 * the state is as it was. MSR_EIO, MSR_EINPUT. */
MSR_API msr_status msr_state_save(const msr_state *state, const char *path, msr_error *err);
MSR_API msr_status msr_state_load(msr_state *state, const char *path, msr_error *err);

/* The system as it is; valid until the state steps or is freed. */
MSR_API msr_view msr_state_view(const msr_state *state);

/* Arrays for a program to change; ask again after every step. To ask is to change: the guard takes
 * what the next step begins with for the start, and steps of care, if they were on, end. */
typedef struct msr_arrays {
  double *x, *y, *vx, *vy; /* [masses] */
} msr_arrays;
MSR_API msr_arrays msr_state_edit(msr_state *state);

/* Iterations done. While the state steps (seen from poll, say) they may go back, by 256 at most, to
 * where its energy was sound (figures.care). */
MSR_API uint64_t msr_state_iteration(const msr_state *state);

/* Advances to `iterations` of DT from here. Methods that split take an evaluation of the forces
 * more in each call where they step row by row (see figures.by_vectors), unless a step ends
 * in a drift: a call is better of many iterations than of one. So they do after each look at all
 * energies, and past supports after 63 steps, or fewer of wide objects. The guard looks at speeds
 * every 16 steps, row by row every 64 drifts, past supports at each, and at all energies every 256
 * steps: MSR_EUNSTABLE names the mass, its longest spring, the time and a step that is stable. With
 * figures.care, x, y, vx, vy are kept every 64 iterations (128 of two steps, 256 of one); once 2 %
 * of what the scene had to give came from nowhere, or was lost where nothing takes any, or the
 * guard refuses the state, it goes back to what was kept, and comes here by steps of that method,
 * over four substeps at most, or less where equations can't be solved. They keep the energy and
 * cost tens of times more; what is crushed at the start begins so. Bits don't depend on how steps
 * are grouped. MSR_ENOMEM if there is no memory for such steps: the state may be stepped again. Or
 * what a force returns. */
MSR_API msr_status msr_state_step(msr_state *state, uint64_t iterations, msr_error *err);

/* The guard: what a driving force returns, or MSR_EUNSTABLE if a number or an energy isn't finite
 * or there is far more kinetic and spring energy than the scene had to give: at the start, by what
 * gravity and pushes lost, by what wind did. */
MSR_API msr_status msr_state_check(msr_state *state, msr_error *err);

/* The most energy that has come from nowhere since the start, by the guard's looks, over what the
 * scene had to give: above a few per cent, a smaller step is called for. A state that went back
 * knows
 * what it knew there. */
MSR_API double msr_state_energy_gain(const msr_state *state);

/* Total force on each mass, fx, fy [masses] [kg px/s^2], contacts apart. What a force returns. */
MSR_API msr_status msr_state_forces(msr_state *state, double *fx, double *fy, msr_error *err);

/* Energies [kg px^2/s^2] and momentum [kg px/s]. */
typedef struct msr_energy {
  double kinetic, spring, gravity;
  double total; /* with the potential of every other conservative force */
  double px, py;
  double longest; /* the largest length of a spring over its rest length; 0: no spring */
} msr_energy;
MSR_API msr_energy msr_state_energy(const msr_state *state);

/* Times that effect i (of msr_plan_effects) was called to step the state, on all masses at once: a
 * force or contact; steps of the integrator; tries of leaps, those of care too; looks of the guard,
 * at energies or speeds; looks and restarts of care. */
MSR_API uint64_t msr_state_calls(const msr_state *state, size_t effect);

/* Wall time that effect i took in msr_state_step, msr_run and msr_state_check so far [s], if the
 * plan is `timed`, else 0. It is of that effect alone: the integrator's is without that of the
 * forces that it asks for, and all together are the time of the steps and checks, but for the
 * callbacks poll and write. What supports and border take is told as one, of the first that is on,
 * or as part of collisions where these are on. Row by row, where forces, kicks and drifts are one
 * loop, the time of the loop is split by what each is measured to take on some rows, now and then:
 * a weight may take none, since it is added while springs are divided. Begins at 0 with the state,
 * and after a load. */
MSR_API double msr_state_seconds(const msr_state *state, size_t effect);

/* Collisions of masses with supports and with each other so far, those included that were taken
 * back with their steps (figures.care). */
MSR_API uint64_t msr_state_contacts(const msr_state *state);

/* Separate objects of the picture that are at rest, found so at one of the looks, 256 steps apart:
 * a step leaves each of their masses where it is, bit by bit, and no force depends on time. They
 * are stepped no more, which changes no bit and no count of collisions, until the state is edited,
 * loaded, copied to or goes back for care. 0 where nothing is left out: with collisions of masses,
 * springs or masses that a program adds, and methods that aren't made of kicks and drifts. */
MSR_API size_t msr_state_resting(const msr_state *state);

/* Steps so far, those that an adaptive method chose and those that ended at an impact or were tried
 * in search of it included, and evaluations of the acceleration, but for those that a call only
 * repeats, row by row, to go on where another ended. All but `careful` begin at 0 after
 * msr_state_load. */
typedef struct msr_work {
  uint64_t steps, evaluations;
  uint64_t leaps, leapt; /* long steps (figures.leaps) among them, and the substeps that they took
                          * the place of */
  uint64_t careful; /* the iteration from which on steps are those of energy-momentum, since energy
                     * had come from nowhere; UINT64_MAX: none, or not since the last change */
} msr_work;
MSR_API msr_work msr_state_work(const msr_state *state);

/* ---- Frames ---------------------------------------------------------------------------------- */

typedef struct msr_renderer msr_renderer;

typedef struct msr_style {
  unsigned scale;                 /* pixels of the frame per unit; 0: 1 */
  unsigned stripes;               /* rows of the scene per stripe; 0: no stripes */
  unsigned char stripe_colour[3]; /* of every other stripe; all 0: green, 0,160,0 */
} msr_style;

/* Draws the states of a plan; the plan must outlive it. `style` may be NULL. MSR_EUSAGE if the
 * scene has no picture or the frame, one pixel of the scene larger on each side, would have 2^31
 * pixels or more; MSR_ENOMEM. */
MSR_API msr_status msr_renderer_create(const msr_plan *plan, const msr_style *style,
                                       msr_renderer **renderer, msr_error *err);

MSR_API void msr_renderer_free(msr_renderer *renderer);

/* Draws the state: the picture is the renderer's, until it draws again. */
MSR_API const msr_picture *msr_renderer_draw(msr_renderer *renderer, const msr_state *state);

/* ---- Runs: frames to where they go ----------------------------------------------------------- */

/* What takes the frames of a run; one of your own is used as the library's are. */
typedef struct msr_sink {
  void *self;
  /* Takes a frame: all of it, or what complete needs. */
  msr_status (*write)(void *self, const msr_state *state, uint64_t frame, msr_error *err);
  /* Finishes and frees; what was written so far stays and is whole. NULL: nothing to do. */
  msr_status (*close)(void *self, msr_error *err);
  /* Called after write, once all sinks took the frame: the part of the work that needs the state no
   * longer, such as drawing, or writing to a disk. It may be called in a thread of the library's
   * (msr_run_options), but never while write or close is. NULL: there is none. */
  msr_status (*complete)(void *self, uint64_t frame, msr_error *err);
} msr_sink;

/* Frames as binary PPM: DIR/frame-000000.ppm ..., each written whole or not at all; DIR
 * and those above it are made.
 * "-" writes them one after the other to standard output, which is made to hold more if it's a pipe
 * and the system can. `style` may be NULL. MSR_EUSAGE if DIR holds frames and `overwrite` is false;
 * with it, frames that were there are removed first. MSR_EIO, MSR_ENOMEM. */
MSR_API msr_status msr_frames_open(const msr_plan *plan, const char *dir, const msr_style *style,
                                   bool overwrite, msr_sink *sink, msr_error *err);

/* Wall time that drawing, not writing, has taken so far [s]. Only for a sink that msr_frames_open
 * has made and that isn't closed; while msr_run completes frames in a thread, only from within what
 * that calls of the sink: write or complete. */
MSR_API double msr_frames_drawing(const msr_sink *sink);

/* CSV with the header frame,time,kinetic,spring,gravity,total,px,py,contacts,longest: energies,
 * momentum, contacts since the last frame, longest spring over its rest length. "-" is standard
 * output; a file appears when the sink is closed. MSR_EIO, MSR_ENOMEM. */
MSR_API msr_status msr_stats_open(const msr_plan *plan, const char *path, msr_sink *sink,
                                  msr_error *err);

/* NumPy array, float64 [frames, masses, 4]: x, y, vx, vy; it appears when the sink is closed, with
 * as many frames as there were (on a pipe the first line tells of all that were planned). MSR_EIO,
 * MSR_ENOMEM. */
MSR_API msr_status msr_trajectory_open(const msr_plan *plan, const char *path, msr_sink *sink,
                                       msr_error *err);

/* Closes a sink; an all-zero one is left alone. */
MSR_API msr_status msr_sink_close(msr_sink *sink, msr_error *err);

typedef struct msr_run_options {
  const msr_sink *sinks; /* [n_sinks], each given every frame in turn; then they complete it */
  size_t n_sinks;
  /* Called with the state before every substep; row by row, before as many as there are up to the
   * next frame or look, or as take a moment, but at most poll_steps (0: any number; few make steps
   * slow); and before every stretch of long steps, which is an iteration or a part of it (NULL:
   * none). A status other than MSR_OK ends the run and comes back unchanged. Running the state
   * again goes on from there. */
  msr_status (*poll)(void *data, const msr_state *state);
  uint64_t poll_steps;
  void *data;
  /* 2 or more: frames are completed by the sinks in a thread that lasts as long as the run, beside
   * the simulation of the next one; what fails there comes back at the next frame or at the end. 0
   * or 1, or if the system has no thread left: in the caller's, before the run goes on. */
  unsigned threads;
} msr_run_options;

/* Runs the state from where it is to the plan's last iteration; `options` may be NULL. Every frame
 * is checked before it goes to the sinks, which stay open; none goes twice, and those that the
 * state has already passed don't come back: where it goes back (figures.care), frames that were
 * given stay as they are. MSR_EUNSTABLE and MSR_ENOMEM as of msr_state_step, or what a force, a
 * sink or poll returns. */
MSR_API msr_status msr_run(msr_state *state, const msr_run_options *options, msr_error *err);

/* ---- Accuracy: what it costs in time --------------------------------------------------------- */

/* A run of the scene with one method at one step or tolerance, compared with the reference at the
 * frames and at the end, up to the horizon. With supports all runs locate impacts
 * (MSR_IMPACTS_LOCATED). */
typedef struct msr_accuracy_point {
  const msr_integrator *integrator;
  uint64_t substeps; /* per iteration */
  double atol;       /* of an adaptive method; else 0 */
  bool stable;       /* false: the run was stopped, or left the truth by the picture's size; rms
                      * and max are INFINITY then, seconds, drift, pixels and order NAN */
  uint64_t steps, evaluations; /* of the run */
  double seconds;  /* of the run: processor time of the thread, which a busy machine hardly changes;
                    * the least of several runs that do nothing else; NAN: none was made */
  double rms, max; /* error of a mass's position over all instants compared [px] */
  double drift;    /* largest difference of the total energy from the reference's, over the largest
                    * kinetic and spring energy; where energy is kept: its change */
  double pixels;   /* share of the frames' pixels that differ; NAN: the scene has no picture */
  double order;    /* measured against the same method at the next larger step; NAN: can't be */
  bool front;      /* nothing is both faster and more accurate */
} msr_accuracy_point;

/* How far a study is. */
typedef struct msr_accuracy_progress {
  const char *text; /* one line for a user: "verlet, 8 substeps" */
  double share;     /* of the budget that is used up, 0..1 */
} msr_accuracy_progress;

typedef struct msr_accuracy_options {
  const msr_integrator *const *integrators; /* [n_integrators] */
  size_t n_integrators; /* 0: all of msr_integrators that are stable at some step */
  double until;         /* [s], rounded up to whole iterations; 0: the scene's whole time */
  double budget;        /* wall time that it may take [s]; 0: 60 */
  double finest;        /* no run aims at less error [px]; 0: 1e-10 */
  /* Called every few milliseconds, while a step isn't longer (NULL: none); a status other than
   * MSR_OK ends the study: what was measured so far is its result, and `complete` is false; while
   * there is no reference yet, the status comes back. */
  msr_status (*poll)(void *data, const msr_accuracy_progress *progress);
  void *data;
} msr_accuracy_options;

/* The figures of a study. */
typedef struct msr_accuracy_figures {
  double until;           /* asked for [s] */
  double horizon;         /* up to here the two references agree [s]: errors mean something */
  uint64_t frames;        /* instants compared, after the start, up to the horizon */
  double reference_error; /* largest difference of the two references up to there [px] */
  const msr_integrator *reference; /* a run of it is the truth, */
  uint64_t reference_substeps;
  double reference_atol;         /* 0: it isn't adaptive */
  const msr_integrator *witness; /* another, unrelated, tells how true it is */
  uint64_t witness_substeps;
  double witness_atol; /* 0: it isn't adaptive */
  size_t masses, springs;
  uint64_t scene_hash; /* of masses, springs, supports, times and forces (name and bytes of the
                        * params): equal for scenes made equally */
  double seconds;      /* that the study took */
  bool complete;       /* false: the budget or poll ended it early */
} msr_accuracy_figures;

typedef struct msr_accuracy msr_accuracy;

/* Runs the scene with every method at many steps or tolerances and compares; coarse runs come
 * before fine ones. The reference is found first, in a quarter of the budget, or half of it if that
 * doesn't reach half of the time: if it isn't enough, how fine the reference is and how far it goes
 * depend on the clock, and so with it all points. What else depends on the clock is `seconds`,
 * `front`, and, where the budget runs out, which points there are. `options` may be NULL.
 * MSR_EUSAGE for options out of range; MSR_EINPUT if there is no mass or no iteration;
 * MSR_EUNSTABLE if no reference can be found, for any length of time; MSR_ENOMEM; what a force or
 * poll returns. */
MSR_API msr_status msr_accuracy_study(const msr_scene *scene, const msr_accuracy_options *options,
                                      msr_accuracy **accuracy, msr_error *err);

MSR_API void msr_accuracy_free(msr_accuracy *accuracy);

MSR_API msr_accuracy_figures msr_accuracy_describe(const msr_accuracy *accuracy);

/* All points, method by method, from the largest step to the smallest; they are the study's. `n`
 * may be 0: when poll or the budget ends a study right after its reference. */
MSR_API const msr_accuracy_point *msr_accuracy_points(const msr_accuracy *accuracy, size_t *n);

/* The fastest point whose largest error, with the reference's own, is at most `error` [px]; NULL:
 * there is none. */
MSR_API const msr_accuracy_point *msr_accuracy_cheapest(const msr_accuracy *accuracy, double error);

/* What brings every mass within `error` [px] of the truth over the run at the least time. */
typedef struct msr_accuracy_choice {
  msr_plan_options options; /* for msr_plan_create */
  double error;             /* estimated, largest at the instants compared [px] */
  double seconds;           /* estimated, of the run */
  double horizon;           /* [s]; below the scene's time if no error can be promised beyond it */
  char reason[MSR_MESSAGE_SIZE]; /* one line */
} msr_accuracy_choice;

/* Chooses by short pilot studies of the scene. `options` may be NULL: its budget is 10 s here.
 * `seconds` aside, the choice depends on the clock only if the budget, or a part of it, runs out:
 * half of it for the reference, a quarter for a first study of the scene's beginning. Errors as of
 * msr_accuracy_study; MSR_EUNSTABLE if nothing tried is as accurate; what poll returns. */
MSR_API msr_status msr_accuracy_choose(const msr_scene *scene, double error,
                                       const msr_accuracy_options *options,
                                       msr_accuracy_choice *choice, msr_error *err);

#ifdef __cplusplus
}
#endif

#endif
