#!/bin/sh
# run.sh - what is off costs nothing: instructions of runs with an effect off, counted by callgrind,
# against those of a build in which its code isn't there, which must give the same trajectory.
#   BUILD=build sh tests/bench/effects/run.sh [EFFECT ...]
#
# For each effect a function out_EFFECT takes it out of a copy of the tree, which is then built; what
# takes out nothing fails. Runs
# are of run.c, or of msr for what the command does. Exit status 1 if any differs by more than 0.5 %
# or in a bit.
set -eu
cd "$(dirname "$0")/../../.."
tree=$PWD
build=$(realpath "${BUILD:-build}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
gsl=$(${PKG_CONFIG:-pkg-config} --cflags --libs gsl)
most=0.5 # [%]

# ---- How each is taken out: in the copy, in libmsr/

edit() { # SCRIPT FILE ...: by sed; each file must change
  script=$1
  shift
  for file; do
    cp "$file" "$scratch/before"
    sed -i "$script" "$file"
    if cmp -s "$file" "$scratch/before"; then
      echo "nothing in $file is changed by $script" >&2
      exit 1
    fi
  done
}

force() { # NAME: without its file and its row in the table
  rm "forces/$1.c"
  edit "/msr_force_$1,/d" scene/tables.c
  if grep -l "&msr_force_$1\\b" scene/*.c plan/*.c > "$scratch/users"; then
    edit "s/&msr_force_$1\\b/NULL/" $(cat "$scratch/users")
  fi
}
out_damping() { force damping; }
out_drag() { force drag; }
out_wind() { force wind; }
out_push() { force push; }

# with what kernels do for it
out_gravity() {
  force gravity
  edit '/if (task->besides & MSRI_WITH_WEIGHT)$/,+1d' forces/lattice_kernel.inc
  edit '/if (term->force->uniform) /d' sweep/stage.c
  edit 's/uniform ? MSRI_WITH_WEIGHT : 0/uniform ? 0 : 0/' sweep/sweep.c
}

# drag and wind, with what kernels do for them
out_air() {
  force drag
  force wind
  edit '/for (int n = 0; n < 2 && (task->besides & MSRI_WITH_AIR); n++) {/,/^  }/d' \
    forces/lattice_kernel.inc
  edit '/for (int n = 0; n < 2 && m->relaxes; n++)/,+1d' sweep/meet.c
  edit '/if (still->air < /d; /^static void relax/,/^}/d' sweep/stage.c
  edit '/const msri_motion \*m = &stage->motion;/d; s/const int air = .*/const int air = 0 * (stage == NULL);/' sweep/field.h
  edit 's/relax ? MSRI_WITH_AIR : 0/relax ? 0 : 0/' sweep/sweep.c
}

# supports and border: no contact is made, and none is asked for
out_supports() {
  edit '/status = add_contact(/d' plan/effects.c
  edit 's/\(state->\)\?plan->contact\./none_in_the_way./g' $(grep -l 'plan->contact\.' plan/*.[ch])
  edit 's/^struct msr_plan {/static const msri_contact none_in_the_way;\n&/' plan/plan.h
  edit 's/\(w->\|s->\|\b\)pass\(->\|\.\)meets/false/g' sweep/patch.c sweep/rows.c \
    sweep/shares.c
  edit 's/msri_plan_meets(plan)/false/g' sweep/sweep.c sweep/deal.c
  edit 's/msri_meet_\(stage_\)\?size([^()]*)/0/g' sweep/patch.c sweep/rows.c sweep/shares.c
  edit 's/msri_meet_place(.*)/{.blocks = 0}/' sweep/shares.c
  rm contacts/supports.c contacts/kept.c contacts/located.c sweep/meet.c sweep/near.c
}

out_collisions() {
  edit '/^static msr_status add_collisions(/,/^}/d; /status = add_collisions(/d' plan/effects.c
  edit '/msri_discs_free(/d' plan/plan.c
  edit 's/\(state->\)\?plan->discs\b/no_discs/g' $(grep -l 'plan->discs\b' plan/*.[ch])
  edit 's/^struct msr_plan {/static msri_discs *const no_discs = NULL;\n&/' plan/plan.h
  rm contacts/discs.c contacts/drift.c
}

# leaps and care
out_leaps() {
  cat > run/leap.h <<'C'
#include "run/step.h"
static inline bool msri_leaps(const msr_state *state) { (void)state; return false; }
static inline msr_status msri_leap(msr_state *state, const msr_system *system,
                                   const msri_poll *poll) {
  (void)state, (void)system, (void)poll;
  return MSR_OK;
}
C
  cat > run/care.h <<'C'
#include "plan/state.h"
static inline msr_status msri_care_begin(msr_state *state, msr_error *err) {
  (void)state, (void)err;
  return MSR_OK;
}
static inline msr_status msri_care_watch(msr_state *state, bool wrong, bool *turned,
                                         msr_error *err) {
  (void)state, (void)wrong, (void)err;
  *turned = false;
  return MSR_OK;
}
static inline uint64_t msri_care_patience(const msr_state *state) {
  (void)state;
  return UINT64_MAX;
}
C
  rm run/leap.c run/care.c
}

# the team of --threads
out_threads() {
  edit '/if (s->team)$/,+2d; /msri_team_free(/d' sweep/sweep.c
  edit 's/deal.threads > 1 ? msri_team_create(.*) : MSR_OK/MSR_OK/' sweep/sweep.c
  edit 's/msri_team_wait(.*);/;/' sweep/sweep.c sweep/rows.c sweep/bands.c
  rm base/team.c
}

# the clocks of -v, and what is measured for it
out_times() {
  cat > sweep/shares.h <<'C'
#include "sweep/tally.h"
typedef struct msri_shares { double *memory; } msri_shares;
static inline size_t msri_shares_size(const msr_plan *plan, int ways) {
  (void)plan, (void)ways;
  return 0;
}
static inline double msri_shares_clock(void) { return 0; }
C
  edit '/msri_shares_measure(/d; /s->shares.drifts =/d; /msri_shares_split(/d' sweep/sweep.c
  edit 's/msri_tally_is_turn(tally)/false/' sweep/meet.c
  rm sweep/shares.c
  cat > plan/meter.h <<'C'
#include <stddef.h>
#include <stdint.h>
typedef struct msri_meter { uint64_t *calls; double *seconds; size_t effect; } msri_meter;
static inline size_t msri_meter_turn(msri_meter *m, size_t effect) {
  (void)m, (void)effect;
  return 0;
}
static inline size_t msri_meter_enter(msri_meter *m, size_t effect) {
  m->calls[effect]++;
  return 0;
}
C
}

# an output of the command: NAME, FILE of libmsr/run
output() {
  edit "s/return msr_$1_open(.*/return MSR_OK;/" ../cli/outputs.c
  rm "run/$2.c"
}
out_frames() {
  edit 's/return s->no_frames ? NULL : s->output;/return NULL;/' ../cli/outputs.c
  edit 's/msr_frames_drawing([^)]*)/0/' ../cli/outputs.c
  output frames frames
}
out_stats() {
  edit 's/return s->stats;/return NULL;/' ../cli/outputs.c
  output stats stats
}
out_trajectory() {
  edit 's/return s->trajectory;/return NULL;/' ../cli/outputs.c
  output trajectory trajectory
}

# ---- Builds

copy=$scratch/tree

link_run() { # TREE BUILD: links run.c with its library
  ${CC:-cc} -std=c11 -O2 -I"$1/include" "$tree/tests/bench/effects/run.c" "$2/libmsr.a" $gsl -lm \
    -o "$2/effects_run"
}

# A copy of the tree, with its objects, so that only what changes is compiled anew.
take_out() { # EFFECT
  rm -rf "$copy"
  mkdir -p "$copy/build/obj"
  cp -a Makefile include libmsr cli "$copy"
  cp -a "$build/obj/libmsr" "$build/obj/cli" "$copy/build/obj"
  cp -a "$build/flags" "$copy/build"
  (cd "$copy/libmsr" && "out_$1") || return 1
  case $1 in frames | stats | trajectory) goal=msr ;; *) goal=libmsr.a ;; esac
  make -C "$copy" -j2 "build/$goal" > "$scratch/log" 2>&1 ||
    { cat "$scratch/log"; return 1; }
  [ $goal = msr ] || link_run "$copy" "$copy/build"
}

# ---- Runs

conf() { # ITERATIONS GRAVITY
  printf 'DT\n0.001\nGRAVITE\n%s\nMASSE\n0.1\nTENSION_RESSORT\n1500\n' "$2"
  printf 'NB_ITERATIONS\n%s\nNB_IMAGES\n4\n' "$1"
}

scenes='assignment block letters'
cp examples/scenes/assignment.ppm examples/scenes/letters.ppm "$scratch"
awk 'BEGIN { print "P3\n120 120\n255"
  for (y = 0; y < 120; y++) for (x = 0; x < 120; x++)
    print (x > 9 && x < 110 && y > 9 && y < 110 ? "255 0 0" : "255 255 255") }' > "$scratch/block.ppm"
conf 64 9.8 > "$scratch/assignment.conf"
conf 64 9.8 > "$scratch/letters.conf"
conf 64 0 > "$scratch/block.conf"
steps=64

counted() { # COMMAND ...: instructions on stdout, what it says in $scratch/said
  valgrind --tool=callgrind --callgrind-out-file=/dev/null "$@" 2> "$scratch/counts" \
    > "$scratch/said" || { cat "$scratch/counts" >&2; exit 1; }
  sed -n 's/.*Collected : //p' "$scratch/counts"
}

# A run of the scene by the programs of a build, the effect being off; its trajectory's sum last.
count() { # BUILD EFFECT SCENE
  set -- "$1" "$2" "$scratch/$3.ppm" "$scratch/$3.conf"
  case $2 in
  frames | stats) # the command, and a record that is neither
    counted "$1/msr" -q "$3" "$4" --no-frames --trajectory "$scratch/record" ;;
  trajectory) counted "$1/msr" -q "$3" "$4" --no-frames --stats "$scratch/record" ;;
  *)
    counted "$1/effects_run" "$3" "$4" $steps "$2"
    cp "$scratch/said" "$scratch/record" ;;
  esac
  cksum < "$scratch/record"
}

known() { # EFFECT SCENE: the count of the whole build, made once for all effects that it serves
  case $1 in
  gravity | supports | trajectory) kind=$1 ;;
  frames | stats) kind=frames ;;
  *) kind=any ;;
  esac
  [ -f "$scratch/$kind-$2" ] || count "$build" "$1" "$2" > "$scratch/$kind-$2"
  cat "$scratch/$kind-$2"
}

# ---- The table

row() { # EFFECT
  take_out "$1" || { echo "$1: NOT TAKEN OUT"; return 1; }
  for scene in $scenes; do
    known "$1" $scene > "$scratch/off"
    count "$copy/build" "$1" $scene > "$scratch/absent"
    echo $(cat "$scratch/off" "$scratch/absent")
  done | awk -v name="$1" -v most=$most '
    { off[NR] = $1; absent[NR] = $4; same[NR] = $2 == $5 && $3 == $6 }
    END {
      line = sprintf("%-12s", name); verdict = NR == 3 && absent[NR] > 0 ? "ok" : "NOT RUN"
      for (i = 1; i <= NR; i++) {
        d = 100 * (off[i] / absent[i] - 1)
        line = line sprintf(" %12d %+7.3f %%", off[i], d)
        if (d > most || d < -most) verdict = "COSTS"
        if (!same[i]) verdict = "OTHER BITS"
      }
      print line "  " verdict
      exit verdict != "ok" }'
}

# Instructions of so many more steps with springs alone.
springs() { # SCENE
  short=$(counted "$build/effects_run" "$scratch/$1.ppm" "$scratch/$1.conf" 32 springs-only)
  long=$(counted "$build/effects_run" "$scratch/$1.ppm" "$scratch/$1.conf" 160 springs-only)
  awk -v scene="$1" -v more=$((long - short)) '{
    printf "%-12s %s masses, %s springs: %.1f instructions a spring and step\n", scene, $1, $3,
      more / 128 / $3 }' "$scratch/said"
}

link_run . "$build"
[ $# -gt 0 ] || set -- gravity damping drag wind air push supports collisions leaps threads times \
  frames stats trajectory
echo "instructions with the effect off, and how many more than where its code isn't there"
printf '%-12s' EFFECT
for scene in $scenes; do printf ' %22s' "$scene"; done
echo
failed=0
for effect; do row "$effect" || failed=1; done
echo 'springs alone, all else off (callgrind has AVX2, not AVX-512):'
for scene in $scenes; do springs $scene; done
exit $failed
