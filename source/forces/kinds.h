/* The kinds of forces, as FORCES(key of the deck, what it is), or FORCES_NAMED where the deck has several by name, a SectionList. A new one is a
 * file and a line here: the file has `NAME_forces`, its table entry, and `NAME_section`, its keys. */
#ifndef FORCES_NAMED
#define FORCES_NAMED(name, about) FORCES(name, about)
#endif
FORCES(contact, "what keeps particles off each other that no bond joins; nothing when absent")
FORCES_NAMED(bars, "reinforcing bars by name; none when absent")
#undef FORCES_NAMED
