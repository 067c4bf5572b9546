/* Vectors of eight lanes: a whole slice in a register of AVX-512. Included by base/lanes.h in files that are compiled for such processors; what each
 * does is said in base/lanes_four.h. */
#ifndef BRECCIA_BASE_LANES_EIGHT_H
#define BRECCIA_BASE_LANES_EIGHT_H

#include "base/lanes.h"

#include <immintrin.h>

LANES_INLINE Lanes lanes_set(double value)
{
  return (Lanes)_mm512_set1_pd(value);
}

LANES_INLINE Lanes lanes_repeated(const double *from)
{
  return lanes_set(*from);
}

LANES_INLINE Lanes lanes_widen(const float *from)
{
  return (Lanes)_mm512_cvtps_pd(_mm256_loadu_ps(from));
}

#pragma GCC diagnostic push /* without optimisation this is a macro of gcc's, which makes a mask of 255 a signed byte */
#pragma GCC diagnostic ignored "-Wsign-conversion"
LANES_INLINE Lanes lanes_gather(const double *from, const int32_t *index)
{
  return (Lanes)_mm512_i32gather_pd(_mm256_loadu_si256((const __m256i *)index), from, 8);
}
#pragma GCC diagnostic pop

/** Two rows of four side by side. */
LANES_INLINE __m512d lanes_pair(const double *low, const double *high)
{
  return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(low)), _mm256_loadu_pd(high), 1);
}

LANES_INLINE void lanes_gather_rows(const double *from, int stride, const int32_t *index, Lanes out[QUAD])
{
  const __m512d a = lanes_pair(from + (int64_t)index[0] * stride, from + (int64_t)index[4] * stride),
                b = lanes_pair(from + (int64_t)index[1] * stride, from + (int64_t)index[5] * stride),
                c = lanes_pair(from + (int64_t)index[2] * stride, from + (int64_t)index[6] * stride),
                d = lanes_pair(from + (int64_t)index[3] * stride, from + (int64_t)index[7] * stride);
  const __m512d even_ab = _mm512_unpacklo_pd(a, b), odd_ab = _mm512_unpackhi_pd(a, b),
                even_cd = _mm512_unpacklo_pd(c, d), odd_cd = _mm512_unpackhi_pd(c, d);
  const __m512i low = _mm512_set_epi64(13, 12, 5, 4, 9, 8, 1, 0), high = _mm512_set_epi64(15, 14, 7, 6, 11, 10, 3, 2);
  out[0] = (Lanes)_mm512_permutex2var_pd(even_ab, low, even_cd);
  out[1] = (Lanes)_mm512_permutex2var_pd(odd_ab, low, odd_cd);
  out[2] = (Lanes)_mm512_permutex2var_pd(even_ab, high, even_cd);
  out[3] = (Lanes)_mm512_permutex2var_pd(odd_ab, high, odd_cd);
}

LANES_INLINE LaneMask lanes_half(unsigned bits, int half)
{
  (void)half;
  return (LaneMask)_mm512_movm_epi64((__mmask8)bits);
}

LANES_INLINE Lanes lanes_intact(unsigned bits, int half, Lanes lanes)
{
  (void)half;
  return (Lanes)_mm512_maskz_mov_pd((__mmask8)bits, (__m512d)lanes);
}

LANES_INLINE Lanes lanes_load_some(const double *from, unsigned bits, int half)
{
  (void)half;
  return (Lanes)_mm512_maskz_loadu_pd((__mmask8)bits, from);
}

LANES_INLINE Lanes lanes_root(Lanes x)
{
  return (Lanes)_mm512_sqrt_pd((__m512d)x);
}

LANES_INLINE Lanes lanes_choose(LaneMask mask, Lanes a, Lanes b)
{
  return (Lanes)_mm512_ternarylogic_epi64((__m512i)mask, (__m512i)a, (__m512i)b, 0xca);
}

LANES_INLINE int lanes_any(LaneMask mask)
{
  return _mm512_movepi64_mask((__m512i)mask) != 0;
}

LANES_INLINE Lanes lanes_absolute(Lanes a)
{
  return (Lanes)_mm512_abs_pd((__m512d)a);
}

typedef __mmask8 LanesWithin;

LANES_INLINE LanesWithin lanes_all_within(void)
{
  return 255;
}

LANES_INLINE LanesWithin lanes_within(LanesWithin so_far, Lanes a, Lanes limit)
{
  return _mm512_mask_cmp_pd_mask(so_far, (__m512d)lanes_absolute(a), (__m512d)limit, _CMP_NGT_UQ);
}

LANES_INLINE LanesWithin lanes_within_where(LanesWithin so_far, unsigned bits, int half, Lanes a, Lanes limit)
{
  (void)half;
  const __mmask8 beyond =
      _mm512_mask_cmp_pd_mask((__mmask8)bits, (__m512d)lanes_absolute(a), (__m512d)limit, _CMP_GT_OQ);
  return (LanesWithin)(so_far & ~beyond);
}

LANES_INLINE int lanes_are_within(LanesWithin within)
{
  return within == 255;
}

#endif
