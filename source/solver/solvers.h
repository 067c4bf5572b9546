/* The solvers, as SOLVER(key of the deck, what it is). A new one is a file and a line here: the file has `NAME_solver`, its table entry, and
 * `NAME_section`, its keys. */
SOLVER(explicit, "explicit dynamics")
SOLVER(implicit, "implicit dynamics, by Newmark's or the HHT method")
SOLVER(static, "equilibrium at rest, by Newton's method")
