/* The list of constitutive laws. A new law is one file and one line in laws.h. */
#ifndef BRECCIA_CONSTITUTIVE_LAW_H
#define BRECCIA_CONSTITUTIVE_LAW_H

#include "base/error.h"
#include "base/text.h"
#include "breccia/breccia.h"
#include <stdbool.h>

/** Built-in laws and those that a program brought along. */
typedef struct LawList {
  const breccia_law *const *own;
  int own_count;
} LawList;

/** @return the k-th law, own ones last, or NULL after the last; `list` may be NULL */
const breccia_law *law_at(const LawList *list, int k);
const breccia_law *law_find(const LawList *list, const char *name);

/** Refuses a law of a program whose tables or functions are not whole, before any of them is used.
 *  @return true after a message */
bool law_refuse(const breccia_law *law, Error *error);

/** Adds which law was probably meant by a name that is none, or the names of all. */
void law_advice(const LawList *list, const char *given, Text *text);

/** What `moduli` says for a uniaxial law: those of a solid with its Young's modulus and a Poisson ratio of 1/4. */
static inline void uniaxial_moduli(double young, double *bulk, double *shear)
{
  *bulk = young / 1.5;
  *shear = young / 2.5;
}

/** `never_crushes` of laws that are elastic in compression, whatever their constants. */
static inline int law_never_crushes(const void *constants)
{
  (void)constants;
  return 1;
}

/** Parameters of a table under one name, for laws. */
#define LAW_PARAMETERS(table) .parameters = (table), .parameter_count = (int)(sizeof(table) / sizeof *(table))

#endif
