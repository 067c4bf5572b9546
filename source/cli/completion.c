/* Completion for bash, and for zsh through its bash emulation; and the manual page: both made from the table of verbs. */
#include "examples.h"
#include "verbs.h"

static const Option options[] = {{"man", NULL, "print the manual page instead"}, {0}};

static void print_completion(void)
{
  printf("# completion of breccia for bash; in zsh first: autoload -U +X bashcompinit && bashcompinit\n"
         "_breccia() {\n  local word=\"${COMP_WORDS[COMP_CWORD]}\"\n  if [ \"$COMP_CWORD\" = 1 ]; then\n"
         "    COMPREPLY=($(compgen -W \"");
  for (int k = 0; verbs[k]; ++k) printf("%s ", verbs[k]->name);
  printf(
      "--help --version\" -- \"$word\"))\n    return\n  fi\n  case \"$word\" in\n  -*) case \"${COMP_WORDS[1]}\" in\n");
  for (int k = 0; verbs[k]; ++k) {
    printf("    %s) COMPREPLY=($(compgen -W \"--help", verbs[k]->name);
    for (const Option *o = verbs[k]->options; o->name; ++o) printf(" --%s", o->name);
    printf("\" -- \"$word\")) ;;\n");
  }
  printf("    esac ;;\n  *) COMPREPLY=($(compgen -f -- \"$word\")) ;;\n  esac\n"
         "  if [ \"${COMP_WORDS[1]} ${COMP_WORDS[COMP_CWORD-1]}\" = 'new --example' ]; then\n"
         "    COMPREPLY=($(compgen -W \"");
  for (const Example *e = examples; e->name; ++e) printf("%s ", e->name);
  printf("\" -- \"$word\"))\n  fi\n}\ncomplete -o filenames -F _breccia breccia\n");
}

/** Text with the dashes and backslashes that troff would change. */
static void print_troff(const char *words)
{
  for (; *words; ++words)
    if (*words == '-')
      printf("\\-");
    else if (*words == '\\')
      printf("\\e");
    else
      putchar(*words);
}

static void print_man(void)
{
  printf(".TH BRECCIA 1 \"\" \"breccia %s\"\n.SH NAME\nbreccia \\- peridynamics for concrete, soil and rock\n"
         ".SH SYNOPSIS\n.B breccia\nVERB [arguments]\n.SH DESCRIPTION\n",
         BRECCIA_VERSION);
  printf("Computes how concrete, soil and rock deform, yield and crack. A deck in YAML says what is computed; results "
         "go to a\n"
         "folder beside it.\n.SH VERBS\n");
  for (int k = 0; verbs[k]; ++k) {
    printf(".SS %s ", verbs[k]->name);
    print_troff(verbs[k]->arguments);
    printf("\n");
    print_troff(verbs[k]->about);
    printf("\n");
    for (const Option *o = verbs[k]->options; o->name; ++o) {
      printf(".TP\n.B \\-\\-");
      print_troff(o->name);
      if (o->argument) {
        printf(" ");
        print_troff(o->argument);
      }
      printf("\n");
      print_troff(o->about);
      printf("\n");
    }
  }
  printf(".SH EXIT STATUS\n0 done; 1 the computation failed or a file could not be written; 2 the deck or the "
         "arguments are wrong; 130 stopped by a "
         "signal.\n");
}

static int run(int argc, char **argv, const Verb *verb)
{
  const char *values[1];
  int first = read_options(argc, argv, verb, values, NULL, NULL);
  if (first < 0) return first == -2 ? 0 : 2;
  if (refuse_more(argc, argv, verb, first, 0)) return 2;
  if (values[0])
    print_man();
  else
    print_completion();
  return 0;
}

const Verb verb_completion = {.name = "completion",
                              .arguments = "[--man]",
                              .about = "print shell completion (bash, zsh) or the manual page",
                              .options = options,
                              .more = "To use it: source <(breccia completion)",
                              .run = run};
