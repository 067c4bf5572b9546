/* The sweep of hybrid bonds whose laws are all Hooke's, on long vectors. */
#include "base/wide.h"

#define VECTOR SLICE
#define Vector Wide
#define vector_load wide_load
#define vector_store wide_store
#define vector_set wide_set
#define vector_where(bits, value) ((bits) == 255 ? (value) : wide_where((uint8_t)(bits), value))
#define HOOKE_TARGET BRECCIA_WIDE
#define HOOKE_RESPOND hybrid_hooke_wide
#include "formulation/hybrid_hooke_text.h"
