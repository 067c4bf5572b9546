/* A reader of our own, because quantities keep their units through every operation: no library of formulas knows any, and
 * 3 m + 2 s must be a mistake. Recursive descent; the grammar stands above each function. */
#include "deck/expression.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 60, MOST_ARGUMENTS = 16 };

typedef struct Reader {
  const char *words, *next;
  const Units *units;
  const Names *names;
  Text *reason;
  const char *wrong; /* where */
  int depth;
} Reader;

__attribute__((format(printf, 3, 4))) static int refuse(Reader *r, const char *at, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  text_add_list(r->reason, format, arguments);
  va_end(arguments);
  r->wrong = at;
  return 1;
}

static const char *peek(Reader *r)
{
  while (*r->next == ' ' || *r->next == '\t' || *r->next == '\n') ++r->next;
  return r->next;
}

static bool begins_name(char c)
{
  return isalpha((unsigned char)c) || c == '_';
}

static size_t name_length(const char *words)
{
  size_t n = 0;
  if (begins_name(*words))
    while (begins_name(words[n]) || isdigit((unsigned char)words[n])) ++n;
  return n;
}

bool expression_is_name(const char *words, size_t length)
{
  return length && name_length(words) == length;
}

/* ---- functions ---- */

/** Refuses two quantities that cannot be added or compared, after a word like "added". */
static int check_alike(Reader *r, const char *at, const Measure *a, const Measure *b, const char *verb)
{
  if (measure_alike(a, b)) return 0;
  Text first = {0}, second = {0};
  measure_describe(a, &first);
  measure_describe(b, &second);
  refuse(r, at, "%s and %s cannot be %s%s", text_words(&first), text_words(&second), verb,
         measure_is_plain(a) || measure_is_plain(b) ? "; give every quantity its unit" : "");
  text_free(&first);
  text_free(&second);
  return 1;
}

static int least(Reader *r, const char *at, int count, Measure *a)
{
  for (int k = 1; k < count; ++k) {
    if (check_alike(r, at, a, &a[k], "compared")) return 1;
    a->value = fmin(a->value, a[k].value);
  }
  return 0;
}

static int greatest(Reader *r, const char *at, int count, Measure *a)
{
  for (int k = 1; k < count; ++k) {
    if (check_alike(r, at, a, &a[k], "compared")) return 1;
    a->value = fmax(a->value, a[k].value);
  }
  return 0;
}

static int root(Reader *r, const char *at, int count, Measure *a)
{
  (void)count;
  if (a->value < 0) return refuse(r, at, "the square root of a number below 0");
  a->value = sqrt(a->value);
  for (int k = 0; k < MEASURE_POWERS; ++k) a->power[k] /= 2;
  a->cycles = false;
  return 0;
}

static int size_of(Reader *r, const char *at, int count, Measure *a)
{
  (void)r, (void)at, (void)count;
  a->value = fabs(a->value);
  return 0;
}

/** A plain number is asked for, because what it becomes depends on its unit. */
static int check_plain(Reader *r, const char *at, const Measure *a, const char *what)
{
  if (measure_is_plain(a)) return 0;
  Text words = {0};
  measure_describe(a, &words);
  refuse(r, at, "%s takes a plain number, not %s; divide it by a quantity of its kind", what, text_words(&words));
  text_free(&words);
  return 1;
}

/* A quotient that is whole but for rounding, like 0.3 m / 0.1 m, counts as whole. */
static double nearly(double value)
{
  const double whole = round(value);
  return fabs(value - whole) < 1e-9 * fmax(1, fabs(whole)) ? whole : value;
}

static int round_off(Reader *r, const char *at, int count, Measure *a)
{
  (void)count;
  a->value = round(a->value);
  return check_plain(r, at, a, "round");
}

static int round_down(Reader *r, const char *at, int count, Measure *a)
{
  (void)count;
  a->value = floor(nearly(a->value));
  return check_plain(r, at, a, "floor");
}

static int round_up(Reader *r, const char *at, int count, Measure *a)
{
  (void)count;
  a->value = ceil(nearly(a->value));
  return check_plain(r, at, a, "ceil");
}

/** Takes an angle with its unit, or a plain number as one in radians. */
static int check_angle(Reader *r, const char *at, Measure *a, const char *what)
{
  const Measure angle = {.power[MEASURE_ANGLE] = 1};
  if (!measure_alike(a, &angle) && !measure_is_plain(a)) {
    Text words = {0};
    measure_describe(a, &words);
    refuse(r, at, "%s takes an angle, like %s(30 deg), or a plain number in radians, not %s", what, what,
           text_words(&words));
    text_free(&words);
    return 1;
  }
  a->power[MEASURE_ANGLE] = 0;
  return 0;
}

static int sine(Reader *r, const char *at, int count, Measure *a)
{
  (void)count;
  a->value = sin(a->value);
  return check_angle(r, at, a, "sin");
}

static int cosine(Reader *r, const char *at, int count, Measure *a)
{
  (void)count;
  a->value = cos(a->value);
  return check_angle(r, at, a, "cos");
}

static int tangent(Reader *r, const char *at, int count, Measure *a)
{
  (void)count;
  a->value = tan(a->value);
  return check_angle(r, at, a, "tan");
}

/** The result of an inverse function. */
static int give_angle(Reader *r, const char *at, Measure *a, double angle, const char *what)
{
  if (check_plain(r, at, a, what)) return 1;
  if (isnan(angle)) return refuse(r, at, "%s takes a number from -1 to 1, not %g", what, a->value);
  a->value = angle;
  a->power[MEASURE_ANGLE] = 1;
  return 0;
}

static int inverse_sine(Reader *r, const char *at, int count, Measure *a)
{
  (void)count;
  return give_angle(r, at, a, asin(a->value), "asin");
}

static int inverse_cosine(Reader *r, const char *at, int count, Measure *a)
{
  (void)count;
  return give_angle(r, at, a, acos(a->value), "acos");
}

static int inverse_tangent(Reader *r, const char *at, int count, Measure *a)
{
  (void)count;
  return give_angle(r, at, a, atan(a->value), "atan");
}

static const struct {
  const char *name;
  int fewest, most;                                                       /* arguments */
  int (*apply)(Reader *r, const char *at, int count, Measure *arguments); /* the result in the first */
} functions[] = {{"min", 1, MOST_ARGUMENTS, least},
                 {"max", 1, MOST_ARGUMENTS, greatest},
                 {"sqrt", 1, 1, root},
                 {"abs", 1, 1, size_of},
                 {"round", 1, 1, round_off},
                 {"floor", 1, 1, round_down},
                 {"ceil", 1, 1, round_up},
                 {"sin", 1, 1, sine},
                 {"cos", 1, 1, cosine},
                 {"tan", 1, 1, tangent},
                 {"asin", 1, 1, inverse_sine},
                 {"acos", 1, 1, inverse_cosine},
                 {"atan", 1, 1, inverse_tangent}};
enum { FUNCTIONS = sizeof functions / sizeof *functions };

void expression_functions(Text *words)
{
  for (int k = 0; k < FUNCTIONS; ++k) text_add(words, "%s%s", k ? ", " : "", functions[k].name);
}

bool expression_is_taken(const char *name)
{
  for (int k = 0; k < FUNCTIONS; ++k)
    if (!strcmp(functions[k].name, name)) return true;
  return !strcmp(name, "pi");
}

/* ---- grammar ---- */

static int read_sum(Reader *r, Measure *value);

/* call: name '(' sum { ',' sum } ')' */
static int read_call(Reader *r, const char *name, size_t length, Measure *value)
{
  int which = 0, count = 0;
  while (which < FUNCTIONS &&
         (strlen(functions[which].name) != length || strncmp(functions[which].name, name, length) != 0))
    ++which;
  if (which == FUNCTIONS) {
    Text all = {0};
    expression_functions(&all);
    refuse(r, name, "there is no function '%.*s'; the functions are %s", (int)length, name, text_words(&all));
    text_free(&all);
    return 1;
  }
  Measure arguments[MOST_ARGUMENTS];
  do {
    ++r->next; /* the bracket or the comma */
    if (count == functions[which].most)
      return refuse(r, r->next, "%s takes %s", functions[which].name,
                    functions[which].most == 1 ? "one number" : "at most 16 numbers");
    if (read_sum(r, &arguments[count++])) return 1;
  } while (*peek(r) == ',');
  if (*r->next != ')') return refuse(r, r->next, "expected ')'");
  ++r->next;
  if (functions[which].apply(r, name, count, arguments)) return 1;
  *value = arguments[0];
  return 0;
}

static bool is_variable(const Reader *r, const char *name, size_t length)
{
  char words[64];
  if (length >= sizeof words) return false;
  memcpy(words, name, length);
  words[length] = 0;
  return r->names->knows(r->names->context, words);
}

/** The unit that follows a number: a word, and further ones joined to it by / or * without blanks, unless they are variables.
 *  @return where it ends; NULL after a mistake */
static const char *unit_end(Reader *r, const char *from)
{
  const char *end = from;
  if (*from == '%') return from + 1;
  for (;;) {
    size_t n = 0;
    while (isalnum((unsigned char)end[n]) || (unsigned char)end[n] >= 0x80)
      ++n; /* the degree sign, the Greek letter of micro */
    end += n;
    if (*end != '/' && *end != '*') return end;
    const char *next = end + 1;
    const size_t length = name_length(next);
    if (!length && !((unsigned char)*next >= 0x80)) return end;
    if (next[length] == '(') return end;
    if (!is_variable(r, next, length)) {
      end = next;
      continue;
    }
    Text ignored = {0};
    Measure unit;
    char words[64];
    snprintf(words, sizeof words, "%.*s", (int)(next + length - from), from);
    const int bad = measure_unit(r->units, words, &unit, &ignored);
    text_free(&ignored);
    if (bad) return end;
    refuse(r, next,
           "'%.*s' is a variable and a unit too; write (%.*s)%c%.*s for the variable, or give it a longer name",
           (int)length, next, (int)(end - r->next), r->next, *end, (int)length, next);
    return NULL;
  }
}

/* number: digits with a point and a power of ten, and a unit, or none */
static int read_number(Reader *r, Measure *value)
{
  char *end, words[64];
  const char *first = r->next;
  const double number = strtod(first, &end);
  if (*first == '0' && (first[1] == 'x' || first[1] == 'X'))
    return refuse(r, first, "hexadecimal numbers are not read here");
  if (!isfinite(number)) return refuse(r, first, "%.*s is too large for a number", (int)(end - first), first);
  *value = (Measure){.value = number};
  const char *unit = end;
  while (*unit == ' ') ++unit;
  if (!begins_name(*unit) && *unit != '%' && !((unsigned char)*unit >= 0x80)) {
    r->next = end;
    if (isdigit((unsigned char)*unit)) return refuse(r, unit, "expected an operator before the second number");
    return 0;
  }
  const char *last = unit_end(r, unit);
  if (!last) return 1;
  snprintf(words, sizeof words, "%.*s", (int)(last - unit < 60 ? last - unit : 60), unit);
  if (is_variable(r, unit, strlen(words)) && name_length(unit) == strlen(words)) {
    Text ignored = {0};
    const int bad = measure_unit(r->units, words, value, &ignored);
    text_free(&ignored);
    if (bad) return refuse(r, unit, "expected an operator before '%s'", words);
  }
  if (measure_unit(r->units, words, value, r->reason)) {
    r->wrong = unit;
    return 1;
  }
  value->value *= number;
  r->next = last;
  if (*last == '^')
    return refuse(r, unit, "write %s%c for the unit, or (%.*s)^%c for the power of the quantity", words,
                  last[1] ? last[1] : '2', (int)(last - first), first, last[1] ? last[1] : '2');
  return 0;
}

/** What stands where a number is expected, in words of what to write instead. */
static int refuse_other(Reader *r)
{
  const char *c = r->next;
  if (!*c) return refuse(r, c, *r->words ? "the expression ends where a number is expected" : "nothing stands in ${}");
  if (*c == '*') return refuse(r, c, "write ^ for powers");
  return refuse(r, c, "expected a number, a variable or '(', found '%c'", *c);
}

/** Reads a sum up to the bracket that closes it. */
static int read_inner(Reader *r, int opening, char close, Measure *value)
{
  r->next += opening;
  if (read_sum(r, value)) return 1;
  if (*peek(r) != close) return refuse(r, r->next, "expected '%c'", close);
  ++r->next;
  return 0;
}

/* atom: number | name | call | '(' sum ')' | '${' sum '}' */
static int read_atom(Reader *r, Measure *value)
{
  const char *c = peek(r);
  if (isdigit((unsigned char)*c) || (*c == '.' && isdigit((unsigned char)c[1]))) return read_number(r, value);
  if (*c == '(') return read_inner(r, 1, ')', value);
  if (*c == '$' && c[1] == '{') return read_inner(r, 2, '}', value);
  const size_t length = name_length(c);
  char name[64];
  if (!length) return refuse_other(r);
  if (length >= sizeof name) return refuse(r, c, "a name has at most 63 letters");
  r->next += length;
  if (*peek(r) == '(') return read_call(r, c, length, value);
  memcpy(name, c, length);
  name[length] = 0;
  if (!strcmp(name, "pi")) {
    *value = (Measure){.value = acos(-1)};
    return 0;
  }
  if (r->names->find(r->names->context, name, value, r->reason)) {
    r->wrong = c;
    return 1;
  }
  return 0;
}

static int read_signed(Reader *r, Measure *value);

/* power: atom [ '^' signed ] */
static int read_power(Reader *r, Measure *value)
{
  if (read_atom(r, value)) return 1;
  if (*peek(r) != '^') return 0;
  const char *at = r->next++;
  Measure power;
  if (read_signed(r, &power) || check_plain(r, at, &power, "a power")) return 1;
  if (value->value < 0 && power.value != floor(power.value))
    return refuse(r, at, "a number below 0 has whole powers only");
  if (value->value == 0 && power.value < 0) return refuse(r, at, "division by zero");
  value->value = pow(value->value, power.value);
  for (int k = 0; k < MEASURE_POWERS; ++k) value->power[k] *= power.value;
  value->cycles = value->cycles && power.value == 1;
  return 0;
}

/* signed: { '+' | '-' } power */
static int read_signed(Reader *r, Measure *value)
{
  const char sign = *peek(r);
  if (sign != '-' && sign != '+') return read_power(r, value);
  if (++r->depth > DEEPEST) return refuse(r, r->next, "nested too deeply");
  ++r->next;
  const int bad = read_signed(r, value);
  if (sign == '-') value->value = -value->value;
  --r->depth;
  return bad;
}

/* product: signed { ( '*' | '/' ) signed } */
static int read_product(Reader *r, Measure *value)
{
  if (read_signed(r, value)) return 1;
  while (*peek(r) == '*' || *r->next == '/') {
    const char *at = r->next++;
    const double sign = *at == '*' ? 1 : -1;
    Measure other;
    if (read_signed(r, &other)) return 1;
    if (sign < 0 && other.value == 0) return refuse(r, at, "division by zero");
    value->value = sign > 0 ? value->value * other.value : value->value / other.value;
    for (int k = 0; k < MEASURE_POWERS; ++k) value->power[k] += sign * other.power[k];
    /* Three times 10 Hz is a frequency still; the inverse of one is a time like any other. */
    const Measure frequency = {.power[MEASURE_TIME] = -1, .cycles = true};
    value->cycles |= sign > 0 && other.cycles;
    for (int k = 0; k < MEASURE_POWERS; ++k) value->cycles &= value->power[k] == frequency.power[k];
  }
  return 0;
}

/* sum: product { ( '+' | '-' ) product } */
static int read_sum(Reader *r, Measure *value)
{
  if (++r->depth > DEEPEST) return refuse(r, r->next, "nested too deeply");
  if (read_product(r, value)) return 1;
  while (*peek(r) == '+' || *r->next == '-') {
    const char *at = r->next++;
    Measure other;
    if (read_product(r, &other)) return 1;
    if (check_alike(r, at, value, &other, *at == '+' ? "added" : "subtracted")) return 1;
    value->value += *at == '+' ? other.value : -other.value;
  }
  --r->depth;
  return 0;
}

int expression_read(const char *words, const Units *units, const Names *names, Measure *value, size_t *at, Text *reason)
{
  Reader r = {.words = words, .next = words, .units = units, .names = names, .reason = reason, .wrong = words};
  int bad = read_sum(&r, value);
  if (!bad && *peek(&r)) {
    const char *c = r.next;
    if (*c == ',')
      bad = refuse(&r, c, "write decimals with a point, like 10.5; commas part the numbers of a function");
    else if (*c == ')')
      bad = refuse(&r, c, "this ')' has no '('");
    else if (*c == '=')
      bad = refuse(&r, c, "nothing is assigned here; variables have their values under 'variables'");
    else
      bad = refuse(&r, c, "expected an operator (+ - * / ^), found '%.*s'", (int)strcspn(c, " "), c);
  }
  if (!bad && !isfinite(value->value)) bad = refuse(&r, words, "the result is not a finite number");
  *at = (size_t)(r.wrong - words);
  return bad;
}
