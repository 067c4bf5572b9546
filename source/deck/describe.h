/* The deck's tables turned into a reference page for people and a JSON Schema for editors. */
#ifndef BRECCIA_DECK_DESCRIBE_H
#define BRECCIA_DECK_DESCRIBE_H

#include "deck/section.h"

/** What the further keys of a chooser section may be: one named table per word. */
typedef struct ParameterTable {
  const char *word, *about;
  const breccia_parameter *parameters;
  int count;
} ParameterTable;

/** Appends docs/deck.md: a table per section, reachable from `root`, and the dimensions with their units. */
void describe_markdown(const Section *root, const ParameterTable *tables, int table_count, Text *text);

/** Appends the table of one section under a heading of its name. */
void describe_section(const Section *section, Text *text);

/** Appends a JSON Schema (draft 2020-12) of the whole deck. */
void describe_json_schema(const Section *root, const ParameterTable *tables, int table_count, Text *text);

/** Appends a Markdown table of one law's parameters. */
void describe_parameters(const breccia_parameter *parameters, int count, Text *text);

#endif
