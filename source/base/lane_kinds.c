#include "base/lane_kinds.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

LaneKind lane_kind(void)
{
#if BRECCIA_LANE_KINDS
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
                    __builtin_cpu_supports("bmi2");
  if (!avx2) return LANES_OF_ALL;
#if BRECCIA_LANE_KINDS > 1
  const char *asked = getenv("BRECCIA_LANES");
  if (asked && !strcmp(asked, "4")) return LANES_OF_AVX2;
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return LANES_OF_AVX512;
#endif
  return LANES_OF_AVX2;
#else
  return LANES_OF_ALL;
#endif
}
