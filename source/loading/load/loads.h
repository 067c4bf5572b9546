/* The loads, as LOAD(name, key of the deck, kind of its value, dimension, meaning), or LOAD_SECTION(name, key, meaning) where keys of its own
 * stand below. A new one is a file and a line here: the file has `NAME_load`, its table entry, and `NAME_load_section` if it has keys of
 * its own. */
#ifndef LOAD_SECTION
#define LOAD_SECTION(name, key, meaning) LOAD(name, key, FIELD_SECTION, NULL, meaning)
#endif
LOAD(body_force, "body force", FIELD_POINT, "force per volume", "force per volume")
LOAD(force, "force", FIELD_POINT, "force", "total force, shared among the particles by volume")
LOAD(gravity, "gravity", FIELD_POINT, "acceleration", "acceleration, times the density")
LOAD(displacement, "displacement", FIELD_FREE_POINT, "length", "prescribed displacement")
LOAD(velocity, "velocity", FIELD_FREE_POINT, "velocity", "prescribed velocity")
LOAD_SECTION(along, "along", "motion prescribed in one direction only")
#undef LOAD_SECTION
#undef LOAD
