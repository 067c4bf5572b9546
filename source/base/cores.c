#define _GNU_SOURCE /* sched_getaffinity */
#include "base/cores.h"

#include <limits.h>
#include <math.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/** Reads up to two numbers from a file. @return how many there are */
static int read_numbers(const char *folder, const char *name, double numbers[2])
{
  char path[PATH_MAX];
  if (snprintf(path, sizeof path, "%s/%s", folder, name) >= (int)sizeof path) return 0;
  FILE *file = fopen(path, "r");
  const int count = file ? fscanf(file, "%lf %lf", &numbers[0], &numbers[1]) : 0;
  if (file) fclose(file);
  return count > 0 ? count : 0;
}

/** Quota over period of one group: cpu.max of version 2, which begins with "max" where there is none, or two files of version 1. */
static double limit_of(const char *folder)
{
  double quota[2], period[2];
  if (read_numbers(folder, "cpu.max", quota) == 2) return quota[0] / quota[1];
  if (read_numbers(folder, "cpu.cfs_quota_us", quota) && read_numbers(folder, "cpu.cfs_period_us", period) &&
      quota[0] > 0)
    return quota[0] / period[0];
  return INFINITY;
}

/** The smallest limit of a group and those that it lies in. A container may see no more than the outermost, which is then its own. */
static double limit_up_from(const char *mount, const char *controllers, const char *group)
{
  char path[PATH_MAX];
  const int root = snprintf(path, sizeof path, "%s/%s", mount, controllers);
  if (root < 0 || (size_t)root + strlen(group) + 1 > sizeof path) return INFINITY;
  strcpy(path + root, group);
  double least = limit_of(path);
  for (char *slash; (slash = strrchr(path, '/')) && slash >= path + root;) {
    *slash = 0;
    least = fmin(least, limit_of(path));
  }
  return least;
}

static bool has_word(const char *list, const char *word)
{
  const size_t length = strlen(word);
  for (; list; list = strchr(list, ',') ? strchr(list, ',') + 1 : NULL)
    if (!strncmp(list, word, length) && (!list[length] || list[length] == ',')) return true;
  return false;
}

double cores_of_groups(const char *mount, const char *membership)
{
  FILE *file = fopen(membership, "r");
  char line[PATH_MAX];
  double least = INFINITY;
  while (file && fgets(line, sizeof line, file)) { /* number:controllers:/group */
    line[strcspn(line, "\n")] = 0;
    char *controllers = strchr(line, ':'), *group = controllers ? strchr(controllers + 1, ':') : NULL;
    if (!group) continue;
    *group++ = 0;
    ++controllers;
    if (!*controllers) {
      least = fmin(least, limit_up_from(mount, ".", group));
      least = fmin(least, limit_up_from(mount, "unified", group));
    } else if (has_word(controllers, "cpu"))
      least = fmin(least, limit_up_from(mount, controllers, group));
  }
  if (file) fclose(file);
  return least;
}

static int cores_of_system(void)
{
#ifdef __linux__
  cpu_set_t set;
  if (!sched_getaffinity(0, sizeof set, &set)) return CPU_COUNT(&set);
#endif
  const long count = sysconf(_SC_NPROCESSORS_ONLN);
  return count > 0 ? (int)count : 1;
}

int cores_available(void)
{
  const double count = cores_of_system(), limit = ceil(cores_of_groups("/sys/fs/cgroup", "/proc/self/cgroup") - 1e-9);
  return (int)fmax(1, fmin(count, limit));
}

int threads_running(const char *path)
{
  FILE *file = fopen(path, "r");
  int count = 0; /* after three load averages */
  if (file && fscanf(file, "%*f %*f %*f %d/", &count) != 1) count = 0;
  if (file) fclose(file);
  return count;
}

bool cores_are_short(void)
{
  return threads_running("/proc/loadavg") > sysconf(_SC_NPROCESSORS_ONLN);
}

int threads_most(void)
{
  enum { SURE = 64, EACH = 16 }; /* a step of 4096 threads on two cores takes two seconds of waiting for each other */
  const int cores = cores_available();
  return cores > SURE / EACH ? EACH * cores : SURE;
}

int threads_by_default(Text *warning)
{
  const char *words = getenv("OMP_NUM_THREADS");
  if (!words || !*words) return cores_available();
  char *end;
  const long wanted = strtol(words, &end, 10); /* of a list for nested teams the first counts */
  if (end > words && (!*end || *end == ',') && wanted > 0 && wanted <= threads_most()) return (int)wanted;
  const int cores = cores_available();
  text_add(warning, "warning: OMP_NUM_THREADS: '%s' is not a number of threads from 1 to %d; %d are used", words,
           threads_most(), cores);
  return cores;
}
