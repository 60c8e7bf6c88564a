/* check.c - checks of the command line as a whole: operands, and options that contradict each other
 * or that would have no effect. */
#include "commands.h"
#include "guess.h"
#include "parse.h"
#include "places.h"
#include "report.h"

#include <string.h>
#include <unistd.h>

static msr_status check_clashes(const settings *s, const option *o, msr_error *err) {
  for (const char *const *other = o->clashes; *other; other++) {
    if (!option_given(s, *other)) continue;
    return fail(err, MSR_EUSAGE, "%s and %s contradict each other", option_spelling(o).text,
                *other);
  }
  return MSR_OK;
}

static msr_status check_options(const settings *s, msr_error *err) {
  msr_status status = MSR_OK;
  for (const option *o = all_options; o->help && status == MSR_OK; o++) {
    if (!(s->given & option_bit(o))) continue;
    const spelling name = option_spelling(o);
    if (!(o->commands & s->command->bit)) {
      return fail(err, MSR_EUSAGE, "%s isn't an option of '%s'", name.text, s->command->name);
    }
    if (o->needs && !option_given(s, o->needs)) {
      return fail(err, MSR_EUSAGE, "%s has no effect without %s", name.text, o->needs);
    }
    status = check_clashes(s, o, err);
  }
  return status;
}

static msr_status check_wind(const settings *s, msr_error *err) {
  if (!option_given(s, "--wind") || !option_given(s, "--drag") || s->drag > 0) return MSR_OK;
  return fail(err, MSR_EUSAGE, "--drag 0 stops --wind, which acts through the drag of the air");
}

/* The library would take two zeros as its default. */
static msr_status check_tolerance(const settings *s, msr_error *err) {
  const char *const name = option_given(s, "--atol") ? "--atol" : "--rtol";
  const bool adaptive = s->integrator && s->integrator->adaptive;
  if (adaptive && !(s->atol + s->rtol > 0)) {
    return fail(err, MSR_EUSAGE, "--atol 0 needs an --rtol above 0: no step is without error");
  }
  if (adaptive || !option_given(s, name)) return MSR_OK;
  return fail(err, MSR_EUSAGE,
              "%s has no effect on %s, whose steps are fixed; 'msr list' shows which integrators "
              "are adaptive",
              name, s->integrator ? s->integrator->name : "the integrator auto");
}

static msr_status check_trajectory(const settings *s, msr_error *err) {
  if (!s->trajectory || strcmp(s->trajectory, "-") != 0) return MSR_OK;
  return fail(err, MSR_EUSAGE, "--trajectory can't go to standard output; name a file");
}

/* What stands where a file should, and is none, may be a command ill spelt. */
static msr_status check_command(const settings *s, msr_error *err) {
  const char *const word = s->file[0];
  if (s->named || !word || strpbrk(word, "./") || access(word, F_OK) == 0) return MSR_OK;
  guess g = {.word = word};
  for (const command *c = commands; c->name; c++) guess_consider(&g, c->name);
  if (g.best) {
    return fail(err, MSR_EUSAGE, "unknown command '%s'; did you mean '%s'?", word, g.best);
  }
  if (s->n_files == s->command->files) return MSR_OK;
  return fail(err, MSR_EUSAGE, "'%s' is neither a command nor a file", word);
}

static msr_status check_files(const settings *s, msr_error *err) {
  const size_t files = s->command->files;
  if (s->n_files == files) return MSR_OK;
  if (s->n_files > files) {
    return fail(err, MSR_EUSAGE, "'%s' is one file too many: '%s' takes %s", s->file[files],
                s->command->name, files ? "a picture and a conf" : "none");
  }
  if (s->n_files == 0) return fail(err, MSR_EUSAGE, "a picture and a conf are missing");
  return fail(err, MSR_EUSAGE, "'%s' is one file of two: a picture and a conf are needed",
              s->file[0]);
}

msr_status settings_check(const settings *s, msr_error *err) {
  static msr_status (*const checks[])(const settings *, msr_error *) = {
      check_command,    check_options, check_wind,  check_tolerance,
      check_trajectory, check_files,   places_check};
  msr_status status = MSR_OK;
  for (size_t i = 0; i < sizeof checks / sizeof checks[0] && status == MSR_OK; i++) {
    status = checks[i](s, err);
  }
  return status;
}
