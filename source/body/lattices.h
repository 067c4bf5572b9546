/* The lattices, as LATTICE(name, dimensions, axes along which rows may run, three primitive vectors in spacings). A new one is a line: all
 * that others know of a lattice follows from its vectors. They have nothing above the diagonal, and the first is the unit vector along x. */
#define ROOT_HALF 0.70710678118654752440
#define ROOT_THREE_QUARTERS 0.86602540378443864676
LATTICE("cubic", 3, 3, {1, 0, 0}, {0, 1, 0}, {0, 0, 1})
/* Its rows run along nearest neighbours, not along the edges of its cubes: they are half as many again as full, and the faces of a box across z
 * are flat. Its layers are squares turned by 45 degrees to those cubes. */
LATTICE("face-centred cubic", 3, 2, {1, 0, 0}, {0, 1, 0}, {0.5, 0.5, ROOT_HALF})
LATTICE("square", 2, 2, {1, 0, 0}, {0, 1, 0}, {0, 0, 1})
LATTICE("hexagonal", 2, 1, {1, 0, 0}, {0.5, ROOT_THREE_QUARTERS, 0}, {0, 0, 1})
LATTICE("line", 1, 1, {1, 0, 0}, {0, 1, 0}, {0, 0, 1})
#undef ROOT_HALF
#undef ROOT_THREE_QUARTERS
