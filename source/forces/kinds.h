/* The kinds of forces, as FORCES(key of the deck, what it is). A new one is a file and a line here: the file has `NAME_forces`, its table
 * entry, and `NAME_section`, its keys. */
FORCES(contact, "what keeps particles off each other that no bond joins; nothing when absent")
