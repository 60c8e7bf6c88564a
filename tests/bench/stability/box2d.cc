/* box2d.cc - Box2D as its manual says: a pixel is 0.1 m, the smallest that it is made for, a mass a
 * disc of a pixel's width that meets supports only, a spring a soft distance joint, a stretch of
 * black pixels a static box; one step per DT, 8 iterations for velocities, 3 for positions. */
#include "beside.h"

#include <box2d/box2d.h>
#include <cstdio>
#include <vector>

namespace {

const float unit = 0.1F; /* m in a pixel */

struct run {
  const problem *p;
  b2World world;
  std::vector<b2Body *> bodies;
};

b2Vec2 metres(double x, double y) {
  return b2Vec2(unit * static_cast<float>(x), unit * static_cast<float>(y));
}

/* By default contacts below 1 m/s are inelastic. */
b2FixtureDef surface(const problem *p, const b2Shape *shape) {
  b2FixtureDef def;
  def.shape = shape;
  def.friction = 0;
  def.restitution = static_cast<float>(p->restitution);
  if (p->restitution == 1) def.restitutionThreshold = 0;
  return def;
}

void add_box(void *self, double from, double to, double row) {
  run *r = static_cast<run *>(self);
  const b2BodyDef where;
  b2PolygonShape box;
  const b2Vec2 half = metres((to - from) / 2, 0.5);
  box.SetAsBox(half.x, half.y, metres((from + to) / 2, row + 0.5), 0);
  const b2FixtureDef def = surface(r->p, &box);
  r->world.CreateBody(&where)->CreateFixture(&def);
}

b2Body *add_mass(run *r, size_t i) {
  const problem *p = r->p;
  b2BodyDef where;
  where.type = b2_dynamicBody;
  where.fixedRotation = true;
  where.position = metres(p->x[i], p->y[i]);
  where.linearVelocity = metres(p->vx[i], p->vy[i]);
  b2Body *body = r->world.CreateBody(&where);
  b2CircleShape disc;
  disc.m_radius = unit / 2;
  b2FixtureDef def = surface(p, &disc);
  def.density = 1;
  if (!(p->diameter > 0)) def.filter.groupIndex = -1;
  body->CreateFixture(&def);
  b2MassData mass = {static_cast<float>(p->m[i]), b2Vec2_zero, 0};
  body->SetMassData(&mass);
  return body;
}

void add_spring(run *r, const bond *l) {
  b2DistanceJointDef def;
  def.bodyA = r->bodies[l->i];
  def.bodyB = r->bodies[l->j];
  def.length = unit * static_cast<float>(l->L);
  def.minLength = 0;
  def.maxLength = b2_maxFloat;
  def.stiffness = static_cast<float>(l->k);
  def.damping = static_cast<float>(r->p->damping);
  r->world.CreateJoint(&def);
}

void *open_box2d(const problem *p) {
  run *r = new run{p, b2World(metres(0, -p->gravity)), {}};
  for_stretches(p, add_box, r);
  for (size_t i = 0; i < p->n; i++) r->bodies.push_back(add_mass(r, i));
  for (size_t i = 0; i < p->n_bonds; i++) add_spring(r, &p->bonds[i]);
  return r;
}

void blow(const problem *p, b2Body *body) {
  const b2Vec2 v = body->GetLinearVelocity(), wind = metres(p->wind, 0);
  body->ApplyForceToCenter(static_cast<float>(p->air) * (wind - v), true);
}

bool advance_box2d(void *self, uint64_t iterations, char *text) {
  (void)text;
  const int velocity_iterations = 8, position_iterations = 3;
  run *r = static_cast<run *>(self);
  for (uint64_t i = 0; i < iterations; i++) {
    if (r->p->air > 0)
      for (b2Body *body : r->bodies) blow(r->p, body);
    r->world.Step(static_cast<float>(r->p->dt), velocity_iterations, position_iterations);
  }
  return true;
}

void read_box2d(void *self, double *x, double *y, double *vx, double *vy) {
  const run *r = static_cast<run *>(self);
  for (size_t i = 0; i < r->bodies.size(); i++) {
    const b2Vec2 q = r->bodies[i]->GetPosition(), v = r->bodies[i]->GetLinearVelocity();
    x[i] = static_cast<double>(q.x / unit), y[i] = static_cast<double>(q.y / unit);
    vx[i] = static_cast<double>(v.x / unit), vy[i] = static_cast<double>(v.y / unit);
  }
}

} // namespace

extern "C" const char *box2d_version(void) {
  static char text[32];
  std::snprintf(text, sizeof text, "%d.%d.%d", b2_version.major, b2_version.minor,
                b2_version.revision);
  return text;
}

extern "C" {
extern const solver solver_box2d = {nullptr, open_box2d, advance_box2d, read_box2d};
}
