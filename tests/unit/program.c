/* Main function of a test program: one program holds the test files of one folder of tests/unit (one matter).
 *
 * usage: tests_MATTER [FILE ...]      for example: tests_laws test_golden test_tangents
 *
 * Without arguments all files run, one after the other; --list prints their names. The exit status is the number of files that
 * failed, or 2 if a name is unknown. The build renames the function main of each test file to FILE_main and writes the list
 * unit_tests.h (tests/CMakeLists.txt). */
#include <stdio.h>
#include <string.h>

#define UNIT_TEST(name) int name##_main(void);
#include "unit_tests.h"
#undef UNIT_TEST

static const struct {
  const char *name;
  int (*run)(void);
} files[] = {
#define UNIT_TEST(name) {#name, name##_main},
#include "unit_tests.h"
#undef UNIT_TEST
};

enum { FILES = sizeof files / sizeof *files };

static int program_find(const char *name)
{
  for (int k = 0; k < FILES; ++k)
    if (!strcmp(files[k].name, name)) return k;
  return -1;
}

int main(int count, char **arguments)
{
  int failed = 0;
  if (count == 2 && !strcmp(arguments[1], "--list")) {
    for (int k = 0; k < FILES; ++k) puts(files[k].name);
    return 0;
  }
  for (int k = 0; count == 1 && k < FILES; ++k) failed += files[k].run() != 0;
  for (int n = 1; n < count; ++n) {
    const int k = program_find(arguments[n]);
    if (k < 0) {
      fprintf(stderr, "%s: no test file is called '%s'; --list prints their names\n", arguments[0], arguments[n]);
      return 2;
    }
    failed += files[k].run() != 0;
  }
  return failed;
}
