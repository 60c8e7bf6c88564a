/* conf.h - the ranges of what a conf says; msr.h has its readers. */
#ifndef MSRI_CONF_H
#define MSRI_CONF_H

#include "base/base.h"

/* Checks a conf that a program filled, as the readers check a file; `name` stands for it in
 * messages. MSR_EINPUT. */
msr_status msri_conf_check(const char *name, const msr_conf *conf, msr_error *err);

#endif
