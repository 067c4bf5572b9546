/* What may stand in a deck, as tables. The reader, its messages, the JSON Schema and docs/deck.md are all made from them.
 *
 * A Section is a map in the deck and a struct in the program; a Field is one key of it and one member of the struct. Every
 * section's struct begins with a SectionHead. Each room declares the sections that it understands. */
#ifndef BRECCIA_DECK_SECTION_H
#define BRECCIA_DECK_SECTION_H

#include "base/text.h"
#include "deck/document.h"
#include "deck/interval.h"
#include "deck/quantity.h"

typedef struct Section Section;

typedef struct SectionHead {
  const char *name; /* key under which it stands in a named list, else NULL */
  const Node *node; /* for messages that come later */
} SectionHead;

typedef struct Length { /* a length, or a number of lattice spacings */
  double value;
  bool in_spacings;
} Length;

typedef struct NumberOrSection { /* a number, or a section from which it follows */
  double value;                  /* NaN where the section is given, or neither */
  void *section;
} NumberOrSection;

typedef struct NumberList {
  double *values;
  int count; /* of rows: numbers, pairs or points */
} NumberList;

typedef struct TextList {
  const char **items;
  int count;
} TextList;

typedef struct SectionList {
  void **items; /* pointers to the section's struct */
  int count;
  SectionHead **by_name; /* the same in the order of their names, for section_find; NULL where they have none */
} SectionList;

typedef struct Reference { /* the name of something that the deck defines elsewhere, or its definition on the spot */
  const char *name;
  void *section;
  const Node *node;
} Reference;

typedef struct ReferenceList {
  Reference *items;
  int count;
} ReferenceList;

typedef enum FieldKind {
  FIELD_NUMBER,            /* double; NaN when optional and absent */
  FIELD_QUANTITY,          /* const Node *: a number whose dimension is known later, for deck_number */
  FIELD_LENGTH,            /* Length */
  FIELD_COUNT,             /* int64_t; -1 when optional and absent */
  FIELD_FLAG,              /* bool */
  FIELD_TEXT,              /* const char * */
  FIELD_NAME,              /* const char *: the name of something that the deck defines elsewhere */
  FIELD_CHOICE,            /* int: index of one of its words; -1 when optional and absent */
  FIELD_POINT,             /* double[3]; a third component left out is 0; NaN when optional and absent */
  FIELD_FREE_POINT,        /* the same, where the word 'free' makes a component NaN */
  FIELD_COUNTS,            /* int64_t[3]; a third left out is 1; -1 when optional and absent */
  FIELD_NUMBERS,           /* NumberList */
  FIELD_PAIRS,             /* NumberList of [time, number] */
  FIELD_POINTS,            /* NumberList of points */
  FIELD_TEXTS,             /* TextList */
  FIELD_SECTION,           /* pointer to the section's struct; NULL when absent */
  FIELD_SECTIONS,          /* SectionList from a YAML list */
  FIELD_ONE_OR_SECTIONS,   /* SectionList from one section, or from a YAML list of one or more */
  FIELD_NAMED,             /* SectionList from a YAML map: name -> section */
  FIELD_REFERENCE,         /* Reference: words, or a section */
  FIELD_REFERENCES,        /* ReferenceList: one of them, or a list */
  FIELD_NUMBER_OR_SECTION, /* NumberOrSection */
  FIELD_VALUES,            /* names with values, and */
  FIELD_FILES,             /* names of files: both have had their effect when a section is read (deck/resolve) */
  FIELD_CHOSEN, /* pointer to a struct of keys that stand in the same map: those of the section that the word under
                              `key` chooses, of the SectionChoice `section` */
} FieldKind;

typedef struct Field {
  const char *key;
  FieldKind kind;
  size_t offset;
  const char *dimension; /* of numbers; of a FIELD_NAME what has the name (deck/names.h); else NULL */
  const char *standard;  /* default as written in a deck; NULL: required; "": optional */
  const char *range;     /* interval like "(0, inf)", in deck units; NULL: any */
  const char *meaning;
  const Section *section;
  const char *const *words;     /* of a choice, NULL after the last; or */
  const char *(*choice)(int k); /* its k-th word, NULL after the last, where other tables have them */
  char group;                   /* of the fields with one letter exactly one is given; 0: none */
} Field;

/** The k-th word of a choice; NULL: it has fewer, or the field is none. */
static inline const char *field_word(const Field *field, int k)
{
  return field->words ? field->words[k] : field->choice ? field->choice(k) : NULL;
}

typedef struct DeckReader {
  const Document *document;
  const Units *units;
  const void *context; /* what Section.parameters needs */
  Error *error;
  int *unknown;         /* counts the messages that are only about unknown names; may be NULL */
  const Section *whole; /* of the deck, to say where a key stands that was given elsewhere; may be NULL */
  Text *files;          /* gathers those that the deck names, a line each: checksum, bytes and name; may be NULL */
} DeckReader;

struct Section {
  const char *name, *about;
  size_t size; /* of the struct */
  const Field *fields;
  int field_count;
  /** Checks what single fields cannot; adds its messages with node_error. May be NULL. */
  void (*check)(const DeckReader *reader, void *section);
  /** For sections whose further keys depend on the word under `chooser`: the table for that word, or NULL after saying
   *  what is wrong. The values (table order, NaN when absent) are stored as double * at `parameters_offset`. */
  const breccia_parameter *(*parameters)(const DeckReader *reader, const Node *chooser, int *count);
  const char *chooser;
  size_t parameters_offset;
};

/** What the section of a FIELD_CHOSEN is. */
typedef struct SectionChoice {
  Section section; /* a name, and nothing else */
  /** The section of the k-th word of the choice. */
  const Section *(*chosen)(int k);
  const char *(*word)(int k); /* the k-th word, NULL after the last */
} SectionChoice;

static inline const SectionChoice *field_choice(const Field *field)
{
  return (const SectionChoice *)(const void *)field->section;
}

/** The field of a key, also of those that a word chooses; NULL if there is none. */
const Field *section_field(const Section *section, const char *key, size_t length);

#define FIELDS(table) .fields = (table), .field_count = (int)(sizeof(table) / sizeof *(table))

/** Reads a map into a section's struct, adding every problem to the reader's error.
 *  @return the struct (in the document's arena), or NULL when the node is no map */
void *section_read(const DeckReader *reader, const Node *node, const Section *section);

/** The node under a key of a section that was read, or the section's own node: where to point in a message. */
const Node *section_node(const void *section, const char *key);

/** Finds a named section in a list. @return NULL if there is none of that name */
void *section_find(const SectionList *list, const char *name);

/** A number with or without a unit from a node, checked against a range. @return 0, or 1 after saying what is wrong */
int deck_number(const DeckReader *reader, const Node *node, const char *label, const char *dimension_name,
                const char *range, double *value);

#endif
