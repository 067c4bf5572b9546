/* Ways in which a load varies in time, as HISTORY(name, key of the deck, kind of its value, dimension, range, meaning), or HISTORY_SECTION(name,
 * key, meaning) where keys of its own stand below,
 * or HISTORY_LIST of other histories. A new one is a file and a line here: the file has `NAME_history`, its table
 * entry, and `NAME_history_section` if it has keys of its own. */
#ifndef HISTORY_SECTION
#define HISTORY_SECTION(name, key, meaning) HISTORY(name, key, FIELD_SECTION, NULL, NULL, meaning)
#endif
#ifndef HISTORY_LIST
#define HISTORY_LIST(name, key, meaning) HISTORY(name, key, FIELD_SECTIONS, NULL, NULL, meaning)
#endif
HISTORY(ramp, "ramp to", FIELD_NUMBER, "time", "(0, inf)", "from 0 to the full value at this time, then constant")
HISTORY(constant, "constant", FIELD_FLAG, NULL, NULL, "the full value from the beginning")
HISTORY(table, "table", FIELD_PAIRS, "1", NULL,
        "factors at times, straight lines between them, constant before and after")
HISTORY_SECTION(sine, "sine", "harmonic")
HISTORY_SECTION(file, "file", "numbers from a file: a record of an earthquake, a column of measurements")
HISTORY(controlled, "controlled", FIELD_FLAG, NULL, NULL,
        "the factor is found by a stage of 'static' so that what its 'control' measures is as prescribed; 0 before, "
        "and kept in stages without control")
HISTORY_LIST(product, "product", "the product of several histories, like a sine times a table")
HISTORY_LIST(sum, "sum", "the sum of several histories")
#undef HISTORY_SECTION
#undef HISTORY_LIST
#undef HISTORY
