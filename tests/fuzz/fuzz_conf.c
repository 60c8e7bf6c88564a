/* fuzz_conf.c - no bytes may make the conf reader misbehave; what it accepts is in range, and reads
 * back as the same values when it is written. */
#include "base/number.h"
#include "formats/conf.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool condition) {
  if (!condition) abort();
}

static int write_conf(const msr_conf *conf, char *text, size_t size) {
  char real[4][MSRI_NUMBER_SIZE];
  return msri_format(text, size,
                     "DT\n%s\nGRAVITE\n%s\nMASSE\n%s\nTENSION_RESSORT\n%s\n"
                     "NB_ITERATIONS\n%" PRIu64 "\nNB_IMAGES\n%" PRIu64 "\n",
                     msri_number_write(conf->dt, real[0]),
                     msri_number_write(conf->gravity, real[1]),
                     msri_number_write(conf->mass, real[2]),
                     msri_number_write(conf->stiffness, real[3]), conf->iterations, conf->images);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  msr_conf conf = {.dt = 0}, back = {.dt = 0};
  msr_error err = {.status = MSR_OK};
  char text[512];
  if (msr_conf_parse("fuzz", (const char *)data, size, &conf, &err)) {
    require(err.status == MSR_EINPUT);
    require(strncmp(err.message, "fuzz:", 5) == 0 && !strchr(err.message, '\n'));
    return 0;
  }
  require(msri_conf_check("fuzz", &conf, NULL) == MSR_OK);
  const int n = write_conf(&conf, text, sizeof text);
  require(n > 0 && (size_t)n < sizeof text);
  require(msr_conf_parse("fuzz", text, (size_t)n, &back, NULL) == MSR_OK);
  require(memcmp(&back, &conf, sizeof conf) == 0);
  return 0;
}
