/* Small things that all rooms use: text, tables, errors, memory, files that are written whole, locks, programs that are asked. */
#include "base/checksum.h"
#include "base/csv.h"
#include "base/folder_lock.h"
#include "base/pace.h"
#include "base/program.h"
#include "base/regular_file.h"
#include "base/whole_file.h"
#include "support.h"

#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

static void write_file(const char *path, const char *words)
{
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fputs(words, file);
  fclose(file);
}

/* ---- text ---- */

static void text_grows_as_it_is_added_to(void **state)
{
  (void)state;
  Text text = {0};
  char expected[4000] = "";
  assert_string_equal(text_words(&text), "");
  assert_null(text_take(&text));
  for (int k = 0; k < 500; ++k) {
    text_add(&text, "%d,", k);
    snprintf(expected + strlen(expected), 16, "%d,", k);
    assert_int_equal(text.length, strlen(expected));
  }
  char *taken = text_take(&text);
  assert_string_equal(taken, expected);
  assert_int_equal(text.length, 0);
  free(taken);
}

static void words_of_json_are_quoted(void **state)
{
  (void)state;
  Text text = {0};
  text_add_json(&text, "a \"b\" \\ \n\t\x1f /\x7f \u00e9");
  assert_string_equal(text_words(&text), "\"a \\\"b\\\" \\\\ \\u000a\\u0009\\u001f /\x7f \u00e9\"");
  text_free(&text);
}

static void distances_of_words_count_slips(void **state)
{
  (void)state;
  static const struct {
    const char *a, *b;
    int distance;
  } cases[] = {{"", "", 0},        {"abc", "", 3},           {"", "abcd", 4},   {"abc", "abc", 0},
               {"abc", "ABC", 0},  {"a-b_c", "a b c", 0},    {"abc", "acb", 1}, {"abcd", "badc", 2},
               {"abc", "abxc", 1}, {"abxc", "abc", 1},       {"abc", "axc", 1}, {"kitten", "sitting", 3},
               {"ca", "abc", 3},   {"spacing", "spcaing", 1}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    assert_int_equal(text_distance(cases[k].a, cases[k].b), cases[k].distance);
    assert_int_equal(text_distance(cases[k].b, cases[k].a), cases[k].distance);
  }
  char long_word[65] = "";
  memset(long_word, 'q', 63);
  assert_int_equal(text_distance(long_word, ""), 63);
  memset(long_word, 'q', 64);
  assert_int_equal(text_distance(long_word, long_word), 64);
  /* One slip of a short word, of longer ones up to a third; and something must be left. */
  assert_true(text_resembles("abcde", "abcdx", 1));
  assert_false(text_resembles("abcde", "abcxx", 2));
  assert_true(text_resembles("abcdef", "abcdxx", 2));
  assert_false(text_resembles("abcdef", "abcxxx", 3));
  assert_true(text_resembles("abcdefghi", "abcdefxxx", 3));
  assert_true(text_resembles("abc", "abcdef", 2));
  assert_false(text_resembles("a", "b", 1));
}

static void names_and_places_of_files_are_made_of_words(void **state)
{
  (void)state;
  char name[12];
  text_file_name("tip x/y.\u00e9_2", name, sizeof name);
  assert_string_equal(name, "tip-x-y.---"); /* as much as there is room for */
  text_file_name("../end", name, sizeof name);
  assert_string_equal(name, "-.-end"); /* a file that is not hidden */
  text_file_name("", name, sizeof name);
  assert_string_equal(name, "-");
  static const char *const beside[][3] = {{"a/b/deck.yaml", "c.csv", "a/b/c.csv"},
                                          {"deck.yaml", "c.csv", "c.csv"},
                                          {"a/deck.yaml", "/c.csv", "/c.csv"},
                                          {NULL, "c.csv", "c.csv"},
                                          {"/deck.yaml", "c.csv", "/c.csv"}};
  for (size_t k = 0; k < sizeof beside / sizeof *beside; ++k) {
    char *path = text_beside(beside[k][0], beside[k][1]);
    assert_string_equal(path, beside[k][2]);
    free(path);
  }
}

static void files_are_read_whole_or_it_is_said_why_not(void **state)
{
  (void)state;
  for (int length = 65534; length <= 65537; ++length) { /* about the size of a first piece */
    FILE *file = fopen("test_base.txt", "wb");
    for (int k = 0; k < length; ++k) fputc('a' + k % 26, file);
    fclose(file);
    size_t found;
    char *words = text_read_file("test_base.txt", &found);
    assert_int_equal(found, length);
    for (int k = 0; k < length; ++k) assert_int_equal(words[k], 'a' + k % 26);
    assert_int_equal(words[length], 0);
    free(words);
    uint32_t sum;
    int64_t bytes;
    assert_int_equal(checksum_of_file("test_base.txt", 0, INT64_MAX, &sum, &bytes), 0);
    assert_int_equal(bytes, length);
  }
  FILE *file = fopen("test_base.txt", "wb");
  fwrite("ab\0cd", 1, 5, file);
  fclose(file);
  size_t length;
  char *words = text_read_file("test_base.txt", &length);
  assert_int_equal(length, 5);
  free(words);
  static const struct {
    const char *path, *why;
  } cases[] = {{"test_base.txt", "it is not text: it holds a zero byte"},
               {"no/such/file", "No such file or directory"},
               {"/dev/null", "it is a pipe or a device; expected a file"},
               {"/", "Is a directory"}};
  for (int k = 0; k < 4; ++k) {
    assert_null(text_read_file(cases[k].path, NULL));
    assert_string_equal(text_why_unread(errno), cases[k].why);
  }
  assert_string_equal(text_why_unread(EFBIG), "it is larger than 4 GB");
  remove("test_base.txt");
}

/** The lowest number that a file would get now. */
static int next_descriptor(void)
{
  const int number = dup(0);
  assert_true(number >= 0);
  close(number);
  return number;
}

/** What cannot be read, or is refused, is closed again. */
static void what_is_not_read_is_not_left_open(void **state)
{
  (void)state;
  const int before = next_descriptor();
  size_t length;
  unlink("test_base.pipe"); /* of a run that failed */
  assert_int_equal(mkfifo("test_base.pipe", 0600), 0);
  const char *const paths[] = {".", "test_base.pipe", "nowhere/at all"};
  for (int k = 0; k < 3; ++k)
    for (int n = 0; n < 3; ++n) {
      assert_int_equal(text_open_file(paths[k]), -1);
      assert_true(!text_read_file(paths[k], &length));
      assert_int_equal(next_descriptor(), before);
    }
  unlink("test_base.pipe");
}

static void checksums_are_those_of_the_standard(void **state)
{
  (void)state;
  uint32_t sum;
  int64_t bytes;
  assert_int_equal(checksum_of("123456789", 9), 0xcbf43926); /* the check value of CRC-32 */
  assert_int_equal(checksum_with(checksum_of("1234", 4), "56789", 5), 0xcbf43926);
  write_file("test_base.txt", "ab123456789cd");
  assert_int_equal(checksum_of_file("test_base.txt", 2, 9, &sum, &bytes), 0);
  assert_int_equal(sum, 0xcbf43926);
  assert_int_equal(bytes, 9);
  assert_int_equal(checksum_of_file("test_base.txt", 11, 9, &sum, &bytes), 0);
  assert_int_equal(sum, checksum_of("cd", 2));
  assert_int_equal(bytes, 2);
  remove("test_base.txt");
  assert_int_equal(checksum_of_file("test_base.txt", 0, 9, &sum, &bytes), 1);
  assert_int_equal(errno, ENOENT);
}

/* ---- tables ---- */

/** The numbers of a column, or what is wrong with it. */
static char *column(const char *content, const char *name, CsvState how)
{
  int count;
  char label[128] = "";
  Error *error = breccia_error_create();
  write_file("test_base.csv", content);
  double *values = csv_column("test_base.csv", name, how, &count, label, error);
  Text text = {0};
  text_add(&text, "%s%s", values ? label : breccia_error_text(error), values ? ":" : "");
  for (int k = 0; values && k < count; ++k) text_add(&text, " %g", values[k]);
  free(values);
  breccia_error_destroy(&error);
  remove("test_base.csv");
  return text_take(&text);
}

static void columns_of_tables_are_read_by_their_names(void **state)
{
  (void)state;
  const struct {
    const char *content, *name;
    CsvState how;
    const char *expected;
  } cases[] = {
      {"time,x (mm), y,xx\n1,2,3,4\n5,6,7,8\n", "time", CSV_FINISHED, "time: 1 5"},
      {"time,x (mm), y,xx\n1,2,3,4\n5,6,7,8\n", "x", CSV_FINISHED, "x (mm): 2 6"},
      {"time,x (mm), y ,xx\n1,2,3,4\n5,6,7,8\n", "y", CSV_FINISHED, "y: 3 7"},
      {"time,x (mm), y,xx\n1,2,3,4\n5,6,7,8", "xx", CSV_FINISHED, "xx: 4 8"},
      {"time,x (mm), y,xx\n1,2,3,4\n5,6,7,8", "xx", CSV_LIVING, "xx: 4"}, /* perhaps 80 soon */
      {"time,x (mm), y,xx\n1,2,3,4\n", "z", CSV_FINISHED,
       "test_base.csv: has no column 'z'; its columns are time,x (mm), y,xx"},
      {"time,x\n1,2\n", "tim", CSV_FINISHED, "test_base.csv: has no column 'tim'; its columns are time,x"},
      {"", "x", CSV_FINISHED, "test_base.csv: has no column 'x'; its columns are none"},
      {"# a\n# b\nx,y\n1,2\n# c\n3,4\n\n  \n5,6\n", "y", CSV_FINISHED, "y: 2 4 6"},
      {"\xef\xbb\xbfx,y\r\n1,2\r\n3,4\r\n", "y", CSV_FINISHED, "y: 2 4"},
      {"\xef\xbb\xbfx,y\r\n1,2\r\n3,4\r\n", "x", CSV_FINISHED, "x: 1 3"},
      {"x,y\n1\n,2\n a , 3 \n4x,5\n", "x", CSV_FINISHED, "x: 1 nan nan nan"},
      {"x,y\n1\n,2\n a , 3 \n4x,5\n", "y", CSV_FINISHED, "y: nan 2 3 5"},
      {"x,y\n1,2\n3,4,\t \n", "y", CSV_FINISHED, "y: 2 4"},
      {"# a\nx,y\n1,2\n# 1,2,3\n3,4,5\n", "y", CSV_FINISHED,
       "test_base.csv:5: has 3 cells, but the heading names 2 columns; write decimals with a point, and one number in "
       "each cell"},
      {"x,y\n1,2\n3,4,5\n", "y", CSV_LIVING, "y: 2 4"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char *found = column(cases[k].content, cases[k].name, cases[k].how);
    if (strcmp(found, cases[k].expected)) fail_msg("'%s' of «%s»: «%s»", cases[k].name, cases[k].content, found);
    free(found);
  }
  CsvWords words;
  write_file("test_base.csv", "x, group \n1, \"a b\" \n2\n3,c,\n# 4,d\n5,\n");
  assert_int_equal(csv_words(&words, "test_base.csv", "group", NULL), BRECCIA_OK);
  static const char *const expected[] = {"a b", "", "c", ""};
  assert_int_equal(words.count, 4);
  for (int k = 0; k < 4; ++k) assert_string_equal(words.cells[k], expected[k]);
  csv_words_destroy(&words);
  assert_int_equal(csv_words(&words, "test_base.csv", "y", NULL), BRECCIA_OK);
  assert_null(words.cells);
  csv_words_destroy(&words);
  remove("test_base.csv");
  Error *error = breccia_error_create();
  assert_int_equal(csv_words(&words, "test_base.csv", "y", error), BRECCIA_USER_ERROR);
  assert_string_equal(breccia_error_text(error), "test_base.csv: No such file or directory");
  breccia_error_destroy(&error);
}

/* ---- errors ---- */

static void errors_say_each_line_once_and_not_too_many(void **state)
{
  (void)state;
  Error *error = breccia_error_create();
  assert_string_equal(breccia_error_text(error), "");
  assert_int_equal(error_add(error, BRECCIA_USER_ERROR, "one %d", 1), BRECCIA_USER_ERROR);
  assert_int_equal(error_add(error, BRECCIA_FAILURE, "one"), BRECCIA_FAILURE);
  assert_int_equal(error_add(error, BRECCIA_FAILURE, "one 1"), BRECCIA_FAILURE);
  assert_int_equal(error_add(error, BRECCIA_FAILURE, "one"), BRECCIA_FAILURE);
  assert_string_equal(breccia_error_text(error), "one 1\none");
  assert_int_equal(error_count(error), 4);
  for (int k = 3; k <= 30; ++k) error_add(error, 1, "line %d", k);
  assert_false(error_is_full(error));
  for (int k = 31; k <= 40; ++k) {
    error_add(error, 1, "line %d", k);
    assert_true(error_is_full(error));
  }
  assert_int_equal(error_count(error), 42);
  const char *last = strrchr(breccia_error_text(error), '\n');
  assert_string_equal(last, "\nand more, which are told when these are mended");
  assert_non_null(strstr(breccia_error_text(error), "\nline 30\n"));
  assert_null(strstr(breccia_error_text(error), "line 31"));
  breccia_error_destroy(&error);
  assert_null(error);
  breccia_error_destroy(&error);
  assert_int_equal(error_add(NULL, BRECCIA_USER_ERROR, "nobody reads this"), BRECCIA_USER_ERROR);
  assert_int_equal(error_count(NULL), 0);
  assert_false(error_is_full(NULL));
}

/* Names of files and keys may hold any sign: none of them begins a line or moves a terminal's cursor. The words that are expected stand in C's own signs. */
static void signs_of_names_stay_in_their_line(void **state)
{
  (void)state;
  const struct {
    const char *given, *seen;
  } cases[] = {
      {"plain words, \u00e9 \u2192 \U0001f300", "plain words, \u00e9 \u2192 \U0001f300"},
      {"", ""},
      {"two\nlines\n", "two\\nlines\\n"},
      {"a\ttab and a\rreturn", "a\\ttab and a\\x0dreturn"},
      {"\033[31mred\177", "\\x1b[31mred\\x7f"},
      {"a C1 control \xc2\x9b, a blank of its kind\u00a0y", "a C1 control \\xc2\\x9b, a blank of its kind\u00a0y"},
      {"latin \xe9 and half a sign \xe2\x82", "latin \\xe9 and half a sign \\xe2\\x82"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    char *visible = breccia_visible_text(cases[k].given);
    assert_string_equal(visible, cases[k].seen);
    breccia_text_free(visible);
    if (!*cases[k].given) continue;
    Error *error = breccia_error_create();
    error_add(error, BRECCIA_USER_ERROR, "%s", cases[k].given);
    assert_string_equal(breccia_error_text(error), cases[k].seen);
    breccia_error_destroy(&error);
  }
}

static void lines_of_another_error_are_added_one_by_one(void **state)
{
  (void)state;
  Error *error = breccia_error_create(), *other = breccia_error_create();
  error_add(error, BRECCIA_USER_ERROR, "one");
  assert_int_equal(error_add_all(error, BRECCIA_FAILURE, other), BRECCIA_FAILURE);
  assert_string_equal(breccia_error_text(error), "one");
  error_add(other, BRECCIA_USER_ERROR, "two\n");
  error_add(other, BRECCIA_USER_ERROR, "one");
  error_add(other, BRECCIA_USER_ERROR, "three");
  assert_int_equal(error_add_all(error, BRECCIA_USER_ERROR, other), BRECCIA_USER_ERROR);
  assert_string_equal(breccia_error_text(error), "one\ntwo\\n\nthree");
  assert_int_equal(error_count(error), 4);
  breccia_error_destroy(&error);
  breccia_error_destroy(&other);
}

static void of_endless_lines_the_ends_are_kept(void **state)
{
  (void)state;
  for (int wide = 0; wide < 2; ++wide) {
    Text line = {0};
    text_add(&line, "begin%s", wide ? "" : "_");
    while (line.length < 5000) text_add(&line, "%s", wide ? "\u00e9" : "q");
    text_add(&line, "end");
    Error *error = breccia_error_create();
    error_add(error, 1, "%s", text_words(&line));
    const char *found = breccia_error_text(error), *gap = strstr(found, " ... ");
    assert_non_null(gap);
    assert_true(strlen(found) <= 4006 && strlen(found) >= 4000);
    assert_int_equal(text_utf8(found, strlen(found)), strlen(found));
    assert_memory_equal(found, text_words(&line), (size_t)(gap - found));
    const size_t rest = strlen(gap + 5);
    assert_true(rest >= 398 && rest <= 400);
    assert_string_equal(gap + 5, text_words(&line) + line.length - rest);
    text_free(&line);
    breccia_error_destroy(&error);
    error = breccia_error_create();
    for (int k = 0; k < 4000; ++k) text_add(&line, "q");
    error_add(error, 1, "%s", text_words(&line));
    assert_string_equal(breccia_error_text(error), text_words(&line));
    text_free(&line);
    breccia_error_destroy(&error);
  }
}

static void where_memory_was_out_nothing_else_is_said(void **state)
{
  (void)state;
  Error *error = breccia_error_create();
  error_add(error, BRECCIA_USER_ERROR, "the first");
  assert_int_equal(error_out_of_memory(error), BRECCIA_FAILURE);
  assert_string_equal(breccia_error_text(error),
                      "out of memory: close other programs, or take fewer particles or threads");
  assert_int_equal(error_count(error), 1);
  breccia_error_destroy(&error);
  error = breccia_error_create();
  error_add(error, BRECCIA_USER_ERROR, "the first");
  error_add(error, BRECCIA_FAILURE, "deck: out of memory: bonds");
  error_add(error, BRECCIA_FAILURE, "the last");
  assert_int_equal(error_out_of_memory(error), BRECCIA_FAILURE);
  assert_string_equal(breccia_error_text(error), "deck: out of memory: bonds");
  assert_int_equal(error_count(error), 1);
  breccia_error_destroy(&error);
  assert_int_equal(error_out_of_memory(NULL), BRECCIA_FAILURE);
  error = breccia_error_create();
  const long before = memory_refusals();
  assert_null(memory_zeroed(SIZE_MAX / 2, 4, "the moon", error));
  assert_int_equal(memory_refusals(), before + 1);
  assert_non_null(strstr(breccia_error_text(error), "out of memory: the moon needs 36893488147419.1 MB"));
  breccia_error_destroy(&error);
}

/* ---- memory ---- */

static void memory_is_zeroed_aligned_and_kept_apart(void **state)
{
  (void)state;
  for (size_t count = 0; count < 40; ++count) {
    char *memory = memory_zeroed(count, 3, "test", NULL);
    assert_non_null(memory);
    assert_int_equal((uintptr_t)memory % 64, 0);
    for (size_t k = 0; k < 3 * count; ++k) assert_int_equal(memory[k], 0);
    free(memory);
  }
  Arena *arena = arena_create();
  unsigned char *pieces[400];
  size_t sizes[400];
  for (size_t k = 0; k < 400; ++k) {
    sizes[k] = k % 50 == 49 ? 70000 : 1 + 37 * k % 1009; /* some longer than what is taken at once */
    pieces[k] = arena_zeroed(arena, sizes[k]);
    assert_int_equal((uintptr_t)pieces[k] % sizeof(double), 0);
    for (size_t n = 0; n < sizes[k]; ++n) assert_int_equal(pieces[k][n], 0);
    memset(pieces[k], (int)(k % 255) + 1, sizes[k]);
  }
  for (size_t k = 0; k < 400; ++k)
    for (size_t n = 0; n < sizes[k]; ++n) assert_int_equal(pieces[k][n], k % 255 + 1);
  assert_string_equal(arena_copy(arena, "abcdef", 3), "abc");
  arena_destroy(&arena);
  assert_null(arena);
  arena_destroy(&arena);
}

/* ---- files and programs ---- */

static void files_are_written_whole_or_not_at_all(void **state)
{
  (void)state;
  Text words = {0};
  Error *error = breccia_error_create();
  write_file("test_base.txt", "old");
  text_add(&words, "new words\n");
  assert_int_equal(whole_file_write("test_base.txt", &words, error), BRECCIA_OK);
  char *found = text_read_file("test_base.txt", NULL);
  assert_string_equal(found, "new words\n");
  free(found);
  assert_int_equal(access("test_base.txt.part", F_OK), -1);
  words.failed = true;
  assert_int_equal(whole_file_write("test_base.txt", &words, error), BRECCIA_FAILURE);
  assert_string_equal(breccia_error_text(error), "test_base.txt: cannot be written: out of memory");
  words.failed = false;
  breccia_error_destroy(&error);
  error = breccia_error_create();
  assert_int_equal(whole_file_write("no/such/folder.txt", &words, error), BRECCIA_FAILURE);
  assert_string_equal(breccia_error_text(error), "no/such/folder.txt: cannot be written: No such file or directory");
  breccia_error_destroy(&error);
  error = breccia_error_create();
  assert_int_equal(mkdir("test_base.folder", 0777), 0);
  assert_int_equal(whole_file_write("test_base.folder", &words, error), BRECCIA_FAILURE);
  assert_string_equal(breccia_error_text(error), "test_base.folder: cannot be written: Is a directory");
  assert_int_equal(access("test_base.folder.part", F_OK), -1);
  rmdir("test_base.folder");
  breccia_error_destroy(&error);
  text_free(&words);
  for (int k = 0; k < 200000; ++k) text_add(&words, "%d,", k); /* more than a piece of a copy */
  assert_int_equal(whole_file_write("test_base.txt", &words, NULL), BRECCIA_OK);
  write_file("test_base.copy", "old");
  assert_int_equal(whole_file_copy("test_base.txt", "test_base.copy"), 0);
  found = text_read_file("test_base.copy", NULL);
  assert_string_equal(found, text_words(&words));
  free(found);
  assert_int_equal(whole_file_copy("no/such/file", "test_base.copy"), ENOENT);
  assert_int_equal(whole_file_copy("test_base.txt", "no/such/file"), ENOENT);
  assert_int_equal(path_settle("test_base.txt"), 0);
  assert_int_equal(folder_of_file_settle("test_base.txt"), 0);
  assert_int_equal(folder_of_file_settle("./test_base.txt"), 0);
  assert_int_equal(folder_of_file_settle("no/such/file"), 1);
  assert_int_equal(path_settle("no/such/file"), 1);
  assert_int_equal(errno, ENOENT);
  text_free(&words);
  remove("test_base.txt");
  remove("test_base.copy");
}

static void a_folder_has_one_holder(void **state)
{
  (void)state;
  FolderLock first, second;
  Error *error = breccia_error_create();
  assert_int_equal(folder_lock_take(&first, ".", error), BRECCIA_OK);
  char *signature = text_read_file("./run.lock", NULL), *process = text_format("process %ld on ", (long)getpid());
  assert_memory_equal(signature, process, strlen(process));
  assert_non_null(strstr(signature, " since 2"));
  assert_non_null(strstr(signature, " UTC"));
  assert_int_equal(folder_lock_take(&second, ".", error), BRECCIA_USER_ERROR);
  char *wanted = text_format(
      ".: another run writes into this folder (%s); wait for its end, or give this one a folder of its own", signature);
  assert_string_equal(breccia_error_text(error), wanted);
  folder_lock_return(&second);
  assert_int_equal(access("run.lock", F_OK), 0);
  folder_lock_return(&first);
  assert_int_equal(access("run.lock", F_OK), -1);
  assert_int_equal(folder_lock_take(&second, ".", NULL), BRECCIA_OK);
  folder_lock_return(&second);
  breccia_error_destroy(&error);
  error = breccia_error_create();
  assert_int_equal(folder_lock_take(&first, "no/such", error), BRECCIA_FAILURE);
  assert_string_equal(breccia_error_text(error), "no/such/run.lock: cannot be written: No such file or directory");
  folder_lock_return(&first);
  breccia_error_destroy(&error);
  error = breccia_error_create(); /* a link leads to a file that is not ours to write over */
  FILE *kept = fopen("test_base.kept", "w");
  assert_non_null(kept);
  assert_true(fputs("precious", kept) >= 0);
  assert_int_equal(fclose(kept), 0);
  assert_int_equal(symlink("test_base.kept", "run.lock"), 0);
  assert_int_equal(folder_lock_take(&first, ".", error), BRECCIA_FAILURE);
  assert_string_equal(breccia_error_text(error), "./run.lock: cannot be written: it is a link; remove it");
  folder_lock_return(&first);
  char *words = text_read_file("test_base.kept", NULL);
  assert_string_equal(words, "precious");
  free(words);
  remove("run.lock");
  remove("test_base.kept");
  breccia_error_destroy(&error);
  free(signature), free(process), free(wanted);
}

static void only_regular_files_are_opened(void **state)
{
  (void)state;
  remove("regular.link"), remove("regular.pipe"), remove("regular.kept");
  FILE *kept = regular_file_stream("regular.kept", "w");
  assert_non_null(kept);
  assert_true(fputs("precious", kept) >= 0);
  assert_int_equal(fclose(kept), 0);
  assert_int_equal(symlink("regular.kept", "regular.link"), 0);
  assert_int_equal(mkfifo("regular.pipe", 0600), 0);
  static const struct {
    const char *path, *words;
  } cases[] = {{"regular.link", "it is a link; remove it"},
               {"regular.pipe", "it is a pipe or a device; expected a file"},
               {"/dev/null", "it is a pipe or a device; expected a file"}};
  static const char *const modes[] = {"r", "w", "a"};
  alarm(20); /* a pipe would be waited for */
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    for (size_t m = 0; m < sizeof modes / sizeof *modes; ++m) {
      assert_null(regular_file_stream(cases[k].path, modes[m]));
      assert_string_equal(regular_file_problem(errno), cases[k].words);
    }
    assert_string_equal(regular_file_problem(regular_file_look(cases[k].path)), cases[k].words);
    assert_int_not_equal(regular_file_make(cases[k].path), 0);
  }
  alarm(0);
  assert_int_equal(regular_file_look("regular.kept"), 0);
  assert_int_equal(regular_file_look("regular.none"), 0);
  char *words = text_read_file("regular.kept", NULL);
  assert_string_equal(words, "precious");
  free(words);
  remove("regular.link"), remove("regular.pipe"), remove("regular.kept");
}

static void programs_answer_in_one_line(void **state)
{
  (void)state;
  static const char *const talks[] = {"sh", "-c", "echo ' one'; echo; echo 'two\\r'; printf '\\tthree'", NULL},
                           *const fails[] = {"sh", "-c",
                                             "echo fine; echo 'what went wrong '; printf '\\001x\\n12 34\\n'; exit 4",
                                             NULL},
                           *const gone[] = {"sh", "-c", "no-such-program-anywhere", NULL};
  Text answer = {0}, reason = {0};
  assert_int_equal(program_ask(talks, &answer, &reason), PROGRAM_DONE);
  assert_string_equal(text_words(&answer), "one  two three");
  assert_int_equal(program_ask(fails, &answer, &reason), PROGRAM_FAILED);
  assert_string_equal(text_words(&reason), "sh ended with status 4: what went wrong");
  text_free(&reason);
  assert_int_equal(program_ask(gone, &answer, &reason), PROGRAM_MISSING);
  text_free(&answer), text_free(&reason);
}

/* ---- numbers ---- */

static void a_pace_forgets_what_is_long_ago(void **state)
{
  (void)state;
  Pace pace = {0};
  assert_near(pace_of(&pace), 0, 0);
  pace_expect(&pace, 0);
  assert_near(pace_of(&pace), 0, 0);
  pace_expect(&pace, 0.2);
  assert_near(pace_of(&pace), 0.2, 1e-15);
  /* An expectation counts like half a second of work, which fades with 10 s. */
  pace_note(&pace, 10, 1);
  const double fade = exp(-0.1);
  assert_near(pace_of(&pace), (0.5 * fade + 1) / (2.5 * fade + 10), 1e-14);
  /* After long work it fades with a tenth of that: what was first counts for exp(-10 / 10) and less. */
  for (int k = 0; k < 1000; ++k) pace_note(&pace, 1, 1);
  assert_near(pace_of(&pace), 1, 1e-4);
  pace_note(&pace, 0, 100);
  assert_true(pace_of(&pace) > 3 && pace_of(&pace) < 4.5);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(text_grows_as_it_is_added_to),
      cmocka_unit_test(words_of_json_are_quoted),
      cmocka_unit_test(distances_of_words_count_slips),
      cmocka_unit_test(names_and_places_of_files_are_made_of_words),
      cmocka_unit_test(files_are_read_whole_or_it_is_said_why_not),
      cmocka_unit_test(what_is_not_read_is_not_left_open),
      cmocka_unit_test(checksums_are_those_of_the_standard),
      cmocka_unit_test(columns_of_tables_are_read_by_their_names),
      cmocka_unit_test(errors_say_each_line_once_and_not_too_many),
      cmocka_unit_test(signs_of_names_stay_in_their_line),
      cmocka_unit_test(lines_of_another_error_are_added_one_by_one),
      cmocka_unit_test(of_endless_lines_the_ends_are_kept),
      cmocka_unit_test(where_memory_was_out_nothing_else_is_said),
      cmocka_unit_test(memory_is_zeroed_aligned_and_kept_apart),
      cmocka_unit_test(files_are_written_whole_or_not_at_all),
      cmocka_unit_test(a_folder_has_one_holder),
      cmocka_unit_test(only_regular_files_are_opened),
      cmocka_unit_test(programs_answer_in_one_line),
      cmocka_unit_test(a_pace_forgets_what_is_long_ago),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
