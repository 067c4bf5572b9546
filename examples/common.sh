# What the report.sh of the examples share. Each is run in its own folder.
set -eu
cd "$(dirname "$0")"
breccia=$PWD/../../build/release/breccia
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT

# summary FOLDER KEY: the number of the first such key in a run's summary
summary() { sed -n "s/.*\"$2\": \([^,}]*\).*/\1/p" "$1/summary.json" | head -1; }

# number VALUE FORMAT [FACTOR]
number() { awk -v x="$1" -v f="$2" -v s="${3:-1}" 'BEGIN {if (x == "") print "not"; else printf f, x * s}'; }

# imbalance FOLDER: of energies, in %; what is less than a hundred-thousandth is rounding, and another one on each machine
imbalance() { awk -v x="$(summary "$1" imbalance)" 'BEGIN {if (x == "" || x == "null") print "not"; else if (x + 0 < 1e-7) print "less than 1e-5"; else printf "%.1g", 100 * x}'; }

# between NAME PAGE: puts what comes in between the marks NAME and 'end of NAME' of a page
between() {
  local new
  new=$(cat)
  { sed "/^<!-- $1 -->\$/q" "$2"; echo; echo "$new"; echo; sed -n "/^<!-- end of $1 -->\$/,\$p" "$2"; } > "$work/page"
  cat "$work/page" > "$2"
}
