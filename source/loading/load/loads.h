/* The loads, as LOAD(name, key of the deck, kind of its value, dimension, meaning), or LOAD_SECTION(name, key, meaning) where keys of its own
 * stand below. A new one is a file and a line here: the file has `NAME_load`, its table entry, and `NAME_load_section` if it has keys of
 * its own. */
#ifndef LOAD_SECTION
#define LOAD_SECTION(name, key, meaning) LOAD(name, key, FIELD_SECTION, NULL, meaning)
#endif
LOAD(body_force, "body force", FIELD_POINT, "force per volume", "force per volume")
LOAD(force, "force", FIELD_POINT, "force", "total force, shared among the particles by volume")
LOAD(moment, "moment", FIELD_POINT, "energy",
     "total moment on particles that have rotations, shared among them by volume, anticlockwise about x, y, z; in the "
     "plane [0, 0, moment]")
LOAD(gravity, "gravity", FIELD_POINT, "acceleration", "acceleration, times the density")
LOAD(base_acceleration, "base acceleration", FIELD_POINT, "acceleration",
     "of the ground under the body, which is seen from there: each particle feels the opposite acceleration, and all "
     "motions are relative to the ground")
LOAD(pressure, "pressure", FIELD_NUMBER, "stress",
     "on the face that 'on' selects, inwards, spread as 'spread' says; its direction stays as the body turns")
LOAD(traction, "traction", FIELD_POINT, "stress",
     "force per area of the face that 'on' selects, spread as 'spread' says; or of 'area'")
LOAD_SECTION(water_pressure, "water pressure", "of water at rest on the face that 'on' selects, growing with depth")
LOAD_SECTION(radial_pressure, "radial pressure", "on a round surface, away from its axis or towards it")
LOAD_SECTION(spring, "spring", "springs to the ground or to other particles")
LOAD_SECTION(dashpots, "dashpots", "a face through which waves leave, and an earthquake may come in")
LOAD(initial_strain, "initial strain", FIELD_NUMBER, "1",
     "strain alike in all directions that the material takes where nothing hinders it: shrinkage below 0, warming "
     "above; "
     "laws are given the strain less this one")
LOAD_SECTION(prestress, "prestress", "tension of bars by which they are shorter than their places in the body")
LOAD(strength_reduction, "strength reduction", FIELD_NUMBER, "1",
     "number F by which the strengths of all materials are divided whose laws tell how (mohr-coulomb, drucker-prager, "
     "j2 "
     "and "
     "multi-yield-j2), for factors of safety: cohesions, yield stresses and tangents of angles of friction. With a "
     "'history' h it is 1 + (F - 1) h")
LOAD(displacement, "displacement", FIELD_FREE_POINT, "length", "prescribed displacement")
LOAD(velocity, "velocity", FIELD_FREE_POINT, "velocity", "prescribed velocity")
LOAD(acceleration, "acceleration", FIELD_FREE_POINT, "acceleration",
     "prescribed acceleration, from rest; its history is integrated over time")
LOAD(rotation, "rotation", FIELD_FREE_POINT, "angle",
     "prescribed rotation of particles that have rotations, about x, y, z, anticlockwise; in the plane [0, 0, angle]; "
     "0 holds them, 'free' leaves one as it is")
LOAD_SECTION(along, "along", "motion prescribed in one direction only")
LOAD(
    reaction, "reaction of", FIELD_TEXT, NULL,
    "forces that a named load, which prescribed a motion to the end of the stage before, exerted on its particles "
    "then; "
    "that load ends, and these take its place: under 'dashpots', which hold nothing at rest, or going back to 0 with a "
    "history, as where ground is dug away")
LOAD_SECTION(motion_field, "field", "motion prescribed by formulas in the particles' places")
LOAD(roller, "roller", FIELD_POINT, "1", "held in this direction, of any length; free across it, without friction")
LOAD_SECTION(support, "support", "a face that is held exactly, by layers of particles outside it")
LOAD_SECTION(tie, "tie", "particles that move together")
LOAD_SECTION(initial_velocity, "initial velocity",
             "velocity that the particles have when the load begins; free after that")
#undef LOAD_SECTION
#undef LOAD
