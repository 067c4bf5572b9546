/* The formulations, one a line. A new one is a file and a line here: the file has `formulation_NAME`, its table entry. */
FORMULATION(correspondence)
FORMULATION(bond_based)
FORMULATION(ordinary)
FORMULATION(hybrid)
FORMULATION(micropolar)
