/* The ways to solve linearised equations, as LINEAR(key of the deck, C name, what it is). A new one is a file and a line here: the file has
 * `NAME_linear`, its table entry. */
LINEAR("direct", direct,
       "by factors of the assembled stiffness (factors.h); for small bodies, and the last resort in the plane")
LINEAR("conjugate gradients", gradients,
       "step by step with products K v, at the price of an evaluation of forces each; nothing is assembled")
LINEAR("minimal residuals", residuals,
       "the same for stiffness that is not symmetric or does not resist every motion; it keeps up to 42 vectors")
