/* rest.c - supports that take energy: what falls comes to rest, and stays. */
#include "suite.h"

static const char dropped[] = "............\n"
                              "..o.........\n"
                              "............\n"
                              "............\n"
                              "............\n"
                              "############\n";
static const char block[] = "............\n"
                            "..oooooo....\n"
                            "..oooooo....\n"
                            "..oooooo....\n"
                            "............\n"
                            "............\n"
                            "............\n"
                            "############\n";
static const char slope[] = "..oooo..........\n"
                            "..oooo..........\n"
                            "................\n"
                            "##..............\n"
                            "####............\n"
                            "######..........\n"
                            "########........\n"
                            "##########......\n"
                            "############....\n"
                            "################\n";
static const char funnel[] = "#....oooooo....#\n"
                             "#....oooooo....#\n"
                             "##............##\n"
                             "###..........###\n"
                             "####........####\n"
                             "#####......#####\n"
                             "######....######\n"
                             "################\n";

static const char why_single[] = "exactly 0: the contact leaves no velocity when a rebound would "
                                 "come back within a step";
static const char why_damped[] = "damping lets inner vibrations die: down to rounding, (eps g t)^2";

#define EXAMPLE .conf = {0.005, 9.8, 0.1, 1500, 1, 1}
#define CLOSED  .scene = {.closed_border = true}
#define JELLY   .scene = {.neighbours = 8, .closed_border = true}

static const hard_case rows[] = {
    {.name = "rest: a mass, e = 0.5",
     .art = dropped,
     EXAMPLE,
     .softness = 0.5,
     .brief = 10000,
     .full = 1000000,
     .wanted = RESTS,
     .growth = 0.01,
     .why = why_single},
    {.name = "rest: a mass, e = 0",
     .art = dropped,
     EXAMPLE,
     .softness = 1,
     .brief = 10000,
     .full = 1000000,
     .wanted = RESTS,
     .growth = 0.01,
     .why = why_single},
    {.name = "rest: a mass, e = 0.95",
     .art = dropped,
     EXAMPLE,
     .softness = 0.05,
     .brief = 20000,
     .full = 1000000,
     .wanted = RESTS,
     .growth = 0.01,
     .why = why_single},
    {.name = "rest: a mass slides, friction",
     .art = dropped,
     EXAMPLE,
     CLOSED,
     .vx = 5,
     .softness = 0.5,
     .friction = 0.3,
     .brief = 10000,
     .full = 1000000,
     .wanted = RESTS,
     .growth = 0.01,
     .why = why_single},
    {.name = "rest: a mass, e = 0.5, located",
     .art = dropped,
     EXAMPLE,
     .softness = 0.5,
     .plan = {.impacts = MSR_IMPACTS_LOCATED},
     .brief = 10000,
     .full = 1000000,
     .wanted = RESTS,
     .growth = 0.01,
     .why = why_single},
    {.name = "rest: a mass slides, located",
     .art = dropped,
     EXAMPLE,
     CLOSED,
     .vx = 5,
     .softness = 0.5,
     .friction = 0.3,
     .plan = {.impacts = MSR_IMPACTS_LOCATED},
     .brief = 10000,
     .full = 1000000,
     .wanted = RESTS,
     .growth = 0.01,
     .why = why_single},
    {.name = "rest: a block, damped",
     .art = block,
     EXAMPLE,
     CLOSED,
     .softness = 0.5,
     .friction = 0.3,
     .damping = 0.5,
     .brief = 10000,
     .full = 500000,
     .wanted = RESTS,
     .growth = 0.01,
     .rest = 1e-12,
     .why = why_damped},
    {.name = "rest: a jelly, damped",
     .art = block,
     EXAMPLE,
     JELLY,
     .softness = 0.5,
     .friction = 0.3,
     .damping = 0.5,
     .brief = 10000,
     .full = 500000,
     .wanted = RESTS,
     .growth = 0.01,
     .rest = 1e-12,
     .why = why_damped},
    {.name = "rest: a jelly, damped, located",
     .art = block,
     EXAMPLE,
     JELLY,
     .softness = 0.5,
     .friction = 0.3,
     .damping = 0.5,
     .plan = {.impacts = MSR_IMPACTS_LOCATED},
     .brief = 10000,
     .full = 500000,
     .wanted = RESTS,
     .growth = 0.01,
     .rest = 1e-12,
     .why = why_damped},
    {.name = "rest: a jelly on stairs",
     .art = slope,
     EXAMPLE,
     JELLY,
     .softness = 0.5,
     .friction = 0.6,
     .damping = 2,
     .brief = 20000,
     .full = 500000,
     .wanted = RESTS,
     .growth = 0.01,
     .rest = 1e-12,
     .why = why_damped},
    {.name = "rest: a jelly in a funnel",
     .art = funnel,
     EXAMPLE,
     JELLY,
     .softness = 0.5,
     .friction = 0.3,
     .damping = 2,
     .brief = 20000,
     .full = 500000,
     .wanted = RESTS,
     .growth = 0.01,
     .rest = 1e-12,
     .why = why_damped},
};

void add_rest(suite *s) {
  for (size_t i = 0; i < LENGTH(rows); i++) add_case(s, &rows[i]);
}
