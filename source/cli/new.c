#include "examples.h"
#include "verbs.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const Option options[] = {{"example", NULL, "the deck of an example instead; without a name: list them"}, {0}};

static const char starter[] =
    "# A deck of Breccia. 'breccia check' tells what it would run, 'breccia run' runs it; docs/deck.md lists every "
    "key.\n"
    "title: Plate with an edge crack\n"
    "units: {length: m, force: kN, time: s}      # plain numbers are in these; \"30 MPa\" works anywhere\n"
    "\n"
    "materials:\n"
    "  rock:\n"
    "    model: elastic                          # 'breccia models' lists them\n"
    "    density: 2.4 t/m3\n"
    "    Young modulus: 30 GPa\n"
    "    Poisson ratio: 0.2\n"
    "\n"
    "body:\n"
    "  plate:\n"
    "    material: rock\n"
    "    lattice: square                         # square in the plane, cubic in space\n"
    "    spacing: 0.01 m\n"
    "    thickness: 0.1 m\n"
    "    shape: {box: {from: [0, 0], to: [0.5 m, 0.5 m]}}\n"
    "\n"
    "cracks:\n"
    "  - {cut: {line: [[0, 0.25], [0.15, 0.25]]}}\n"
    "\n"
    "peridynamics: {space: plane stress, horizon: 3.015 spacings}\n"
    "failure: {critical stretch: 0.0005, near grips: hold}\n"
    "\n"
    "loads:\n"
    "  - {name: pull, on: {face: y+, layers: 3}, velocity: [free, 0.1 m/s]}\n"
    "  - {on: {face: y-, layers: 3}, velocity: [free, -0.1 m/s]}\n"
    "\n"
    "solve: {explicit: {end time: 2.0e-3 s}}     # the time step is found by the program\n"
    "\n"
    "watch:\n"
    "  opening: {opening between: [[0, 0.245], [0, 0.255]]}\n"
    "  grip: {force on: {face: y+, layers: 3}}\n"
    "  energy: {energy: yes}\n"
    "\n"
    "pictures:\n"
    "  - {field: damage}\n"
    "  - {field: stress, component: yy, deformed: 100}\n"
    "  - {curve: 'opening.opening : grip.y'}\n";

/** Writes a new file; says why if that fails. @return status of the command */
static int write_new(const char *path, const void *bytes, size_t length)
{
  FILE *file = fopen(path, "wx");
  if (!file) {
    const char *reason = errno == EEXIST   ? "exists already; choose another name"
                         : errno == ENOENT ? "cannot be written: the folder does not exist; make it first"
                                           : strerror(errno);
    complain("%s: %s", path, reason);
    return 2;
  }
  bool bad = fwrite(bytes, 1, length, file) != length;
  bad |= fclose(file) != 0;
  if (bad) {
    complain("%s: cannot be written: %s", path, strerror(errno));
    remove(path);
  }
  return bad;
}

/** Whether a file holds these bytes and no others. */
static bool holds(const char *path, const ExampleFile *file)
{
  char *content = malloc(file->length + 1);
  FILE *there = fopen(path, "rb");
  const bool same = content && there && fread(content, 1, file->length + 1, there) == file->length &&
                    !memcmp(content, file->bytes, file->length);
  if (there) fclose(there);
  free(content);
  return same;
}

/** Path of a file in the folder of another. To be freed; NULL when memory is out, after saying so. */
static char *beside(const char *path, const char *file)
{
  const char *slash = strrchr(path, '/');
  return slash ? words_of("%.*s/%s", (int)(slash - path), path, file) : words_of("%s", file);
}

static const char *short_name(const Example *example)
{
  return strrchr(example->name, '/') + 1;
}

/** Ends the command when memory is out. @param[out] title  to be freed; may be NULL */
static bool is_test(const Example *example, char **title)
{
  int test;
  char *words = breccia_deck_title((const char *)example->files[0].bytes, &test);
  if (!words) {
    fprintf(stderr, "breccia: out of memory: the title of an example\n");
    _Exit(BRECCIA_FAILURE);
  }
  if (title)
    *title = words;
  else
    breccia_text_free(words);
  return test;
}

static void list_examples(bool tests)
{
  for (const Example *e = examples; e->name; ++e) {
    char *title;
    if (is_test(e, &title) == tests) printf("  %-41s %s\n", e->name, title);
    breccia_text_free(title);
  }
}

/** Whether these are words for a file, where names of examples have no ending. */
static bool is_deck(const char *words)
{
  const size_t length = strlen(words);
  return length > 5 && !strcmp(words + length - 5, ".yaml");
}

/** The example of this name, or of this deck if no other folder has one of that name; else says which there are. */
static const Example *find_example(const char *name)
{
  const Example *found = NULL;
  int count = 0;
  for (const Example *e = examples; e->name; ++e) {
    if (!strcmp(e->name, name)) return e;
    if (!strcmp(short_name(e), name)) {
      found = e;
      ++count;
    }
  }
  if (count == 1) return found;
  int near = 0;
  for (const Example *e = examples; e->name; ++e) {
    const char *place = strchr(name, '/') ? e->name : short_name(e);
    if (count ? strcmp(place, name) : !strstr(e->name, name) && !breccia_nearest_word(name, &place, 1)) continue;
    if (near++)
      fprintf(stderr, ", ");
    else if (count > 1)
      fprintf(stderr, "breccia new: several examples are called '%s': give one of ", name);
    else
      fprintf(stderr, "breccia new: there is no example '%s'; the nearest names are ", name);
    fprintf(stderr, "'%s'", e->name);
  }
  if (near)
    fprintf(stderr, "\n");
  else
    complain("breccia new: there is no example '%s'; 'breccia new --example' lists them", name);
  return NULL;
}

static int write_example(const Example *example, const char *path)
{
  char *written[MOST_EXAMPLE_FILES] = {0};
  int count = 0, status = 0;
  for (const ExampleFile *f = example->files + 1; f->name && !status; ++f) {
    char *companion = beside(path, f->name);
    const bool there = companion && holds(companion, f);
    if (!there) status = companion ? write_new(companion, f->bytes, f->length) : BRECCIA_FAILURE;
    if (companion && !there && !status)
      written[count++] = companion;
    else
      free(companion);
  }
  if (!status) status = write_new(path, example->files[0].bytes, example->files[0].length);
  if (!status) {
    printf("%s is written", path);
    for (int k = 0; k < count; ++k) printf("%s %s", k ? "," : ", and", written[k]);
    printf("; 'breccia %s %s' runs it\n", is_test(example, NULL) ? "material" : "run", path);
  }
  for (int k = 0; k < count; ++k) {
    if (status) remove(written[k]);
    free(written[k]);
  }
  return status;
}

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[1];
  int first = read_options(argc, argv, verb, values, NULL, NULL);
  if (first < 0) return first == -2 ? 0 : 2;
  const int given = argc - first;
  if (values[0] && given == 0) {
    printf("Decks, for 'breccia run':\n");
    list_examples(false);
    printf("\nTests in the laboratory on one material point, for 'breccia material':\n");
    list_examples(true);
    printf("\n'breccia new --example NAME DECK' writes one of them.\n");
    return 0;
  }
  if (values[0] && given <= 2) {
    // NAME DECK; but who writes DECK --example NAME says the deck first
    const char *last = given == 2 ? argv[first + 1] : NULL;
    const bool exchanged = last && is_deck(argv[first]) && !is_deck(last);
    const Example *example = find_example(exchanged ? last : argv[first]);
    return example ? write_example(example, exchanged ? argv[first] : last ? last : example->files[0].name) : 2;
  }
  if (given != 1) {
    fprintf(stderr, "breccia new: give the name of the deck to write, like plate.yaml\n");
    return 2;
  }
  int status = write_new(argv[first], starter, sizeof starter - 1);
  if (!status) printf("%s is written; 'breccia run %s' runs it\n", argv[first], argv[first]);
  return status;
}

const Verb verb_new = {
    .name = "new",
    .arguments = "DECK, or breccia new --example [NAME [DECK]]",
    .about = "write a commented deck to start from, or the deck of an example",
    .options = options,
    .more = "Without a NAME the examples are listed. Files that a deck needs are written beside it; nothing that\n"
            "exists is written over.",
    .run = run};
