/* The failure criteria, as CRITERION(name). A new one is a file and a line here: the file has `criterion_NAME`, its table entry. The first is
 * the one of decks that do not say which. */
CRITERION(critical_stretch)
CRITERION(critical_energy)
CRITERION(critical_stress)
