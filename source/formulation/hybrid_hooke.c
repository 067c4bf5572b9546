/* The sweep of hybrid bonds whose laws are all Hooke's, on short vectors. */
#include "base/lanes.h"

#define VECTOR LANES
#define Vector Lanes
#define vector_load lanes_load
#define vector_store lanes_store
#define vector_set lanes_set
#define vector_where(bits, value) ((bits) == 15 ? (value) : lanes_where(lanes_mask(bits), value))
#define HOOKE_TARGET BRECCIA_CLONES
#define HOOKE_RESPOND hybrid_hooke_narrow
#include "formulation/hybrid_hooke_text.h"
