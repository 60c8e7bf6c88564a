/* instants.h - when runs are compared. */
#ifndef MSRI_INSTANTS_H
#define MSRI_INSTANTS_H

#include "base/base.h"

typedef struct msri_instants {
  size_t n;
  uint64_t *iteration; /* [n] rising, from 1 on */
} msri_instants;

typedef struct msri_instants_wanted {
  uint64_t iterations, images; /* of the scene */
  uint64_t end;                /* the last instant */
  uint64_t fewest;             /* fewer frames have others between them */
  uint64_t most;               /* 2 at least: more frames are passed over */
  double ratio; /* early instants are no further apart than by this factor; 0: they may be */
} msri_instants_wanted;

/* The caller frees iteration. MSR_ENOMEM. */
msr_status msri_instants_choose(const msri_instants_wanted *wanted, msri_instants *instants,
                                msr_error *err);

#endif
