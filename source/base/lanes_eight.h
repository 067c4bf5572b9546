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

/** Loaded one by one: the instruction for it takes 2.5 times as long on processors of AMD. */
LANES_INLINE Lanes lanes_gather(const double *from, const int32_t *index)
{
  const __m128d a = _mm_loadh_pd(_mm_load_sd(from + index[0]), from + index[1]),
                b = _mm_loadh_pd(_mm_load_sd(from + index[2]), from + index[3]),
                c = _mm_loadh_pd(_mm_load_sd(from + index[4]), from + index[5]),
                d = _mm_loadh_pd(_mm_load_sd(from + index[6]), from + index[7]);
  const __m256d low = _mm256_insertf128_pd(_mm256_castpd128_pd256(a), b, 1),
                high = _mm256_insertf128_pd(_mm256_castpd128_pd256(c), d, 1);
  return (Lanes)_mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1);
}

/** Two rows of four side by side. */
LANES_INLINE __m512d lanes_pair(const double *low, const double *high)
{
  return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(low)), _mm256_loadu_pd(high), 1);
}

/** What lanes_gather_rows does, in two parts: rows are loaded, and turned round. */
LANES_INLINE void lanes_load_rows(const double *from, int stride, const int32_t *index, Lanes rows[QUAD])
{
  for (int k = 0; k < QUAD; ++k)
    rows[k] = (Lanes)lanes_pair(from + (int64_t)index[k] * stride, from + (int64_t)index[QUAD + k] * stride);
}

LANES_INLINE void lanes_turn_rows(const Lanes rows[QUAD], Lanes out[QUAD])
{
  const __m512d a = (__m512d)rows[0], b = (__m512d)rows[1], c = (__m512d)rows[2], d = (__m512d)rows[3];
  const __m512d even_ab = _mm512_unpacklo_pd(a, b), odd_ab = _mm512_unpackhi_pd(a, b),
                even_cd = _mm512_unpacklo_pd(c, d), odd_cd = _mm512_unpackhi_pd(c, d);
  const __m512i low = _mm512_set_epi64(13, 12, 5, 4, 9, 8, 1, 0), high = _mm512_set_epi64(15, 14, 7, 6, 11, 10, 3, 2);
  out[0] = (Lanes)_mm512_permutex2var_pd(even_ab, low, even_cd);
  out[1] = (Lanes)_mm512_permutex2var_pd(odd_ab, low, odd_cd);
  out[2] = (Lanes)_mm512_permutex2var_pd(even_ab, high, even_cd);
  out[3] = (Lanes)_mm512_permutex2var_pd(odd_ab, high, odd_cd);
}

LANES_INLINE void lanes_gather_rows(const double *from, int stride, const int32_t *index, Lanes out[QUAD])
{
  Lanes rows[QUAD];
  lanes_load_rows(from, stride, index, rows);
  lanes_turn_rows(rows, out);
}

/** Four rows of two side by side. */
LANES_INLINE __m512d lanes_pairs(const double *from, int32_t a, int32_t b, int32_t c, int32_t d)
{
  __m512d four = _mm512_castpd128_pd512(_mm_loadu_pd(from + 2 * (int64_t)a));
  four = _mm512_insertf64x2(four, _mm_loadu_pd(from + 2 * (int64_t)b), 1);
  four = _mm512_insertf64x2(four, _mm_loadu_pd(from + 2 * (int64_t)c), 2);
  return _mm512_insertf64x2(four, _mm_loadu_pd(from + 2 * (int64_t)d), 3);
}

LANES_INLINE void lanes_gather_pairs(const double *from, const int32_t *index, Lanes out[2])
{
  const __m512d even = lanes_pairs(from, index[0], index[2], index[4], index[6]),
                odd = lanes_pairs(from, index[1], index[3], index[5], index[7]);
  out[0] = (Lanes)_mm512_unpacklo_pd(even, odd);
  out[1] = (Lanes)_mm512_unpackhi_pd(even, odd);
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

LANES_INLINE void lanes_store_some(double *to, unsigned bits, int half, Lanes lanes)
{
  (void)half;
  lanes_store(to, (Lanes)_mm512_maskz_compress_pd((__mmask8)bits, (__m512d)lanes));
}

LANES_INLINE void lanes_spread_some(double *to, unsigned bits, const double *from)
{
  _mm512_mask_storeu_pd(to, (__mmask8)bits, _mm512_maskz_expand_pd((__mmask8)bits, (__m512d)lanes_load(from)));
}

LANES_INLINE Lanes lanes_root(Lanes x)
{
  return (Lanes)_mm512_sqrt_pd((__m512d)x);
}

LANES_INLINE Lanes lanes_choose(LaneMask mask, Lanes a, Lanes b)
{
  return (Lanes)_mm512_ternarylogic_epi64((__m512i)mask, (__m512i)a, (__m512i)b, 0xca);
}

LANES_INLINE unsigned lanes_bits(LaneMask mask)
{
  return _mm512_movepi64_mask((__m512i)mask);
}

LANES_INLINE int lanes_any(LaneMask mask)
{
  return lanes_bits(mask) != 0;
}

LANES_INLINE Lanes lanes_least(Lanes a, Lanes b)
{
  return (Lanes)_mm512_min_pd((__m512d)b, (__m512d)a);
}

LANES_INLINE Lanes lanes_greatest(Lanes a, Lanes b)
{
  return (Lanes)_mm512_max_pd((__m512d)b, (__m512d)a);
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
