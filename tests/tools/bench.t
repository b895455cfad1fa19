# SPDX-License-Identifier: GPL-3.0-or-later
# scripts/bench: medians, ratios, and what it refuses, on benchmarks whose times are known.
. "$VAM_SOURCE/tests/tools/testlib.sh"
bench="$VAM_SOURCE/scripts/bench"
VAM_LOADAVG=$scratch/load; export VAM_LOADAVG
echo '0.10 0.20 0.30 1/100 1234' >load

mkdir -p build/bin
cat >build/some_bench <<'SH'
#!/bin/sh
[ "$1" != --benchmark_list_tests ] || { echo sum/8; exit; }
echo "$*" >>calls
times=${TIMES:-30 10 20}
echo '{"benchmarks": ['
for time in $times; do
  echo "{\"run_name\": \"sum/8\", \"run_type\": \"iteration\", \"real_time\": $time, \"time_unit\": \"us\"},"
done
echo '{"run_name": "sum/8", "run_type": "aggregate", "real_time": 99, "time_unit": "us"}]}'
SH
printf '#!/bin/sh\nexit 0\n' >build/bin/vam-none
chmod +x build/some_bench build/bin/vam-none

quiet "medians" "$bench" -o first.json build
is "of three runs" "$(json first.json median_ms.some_bench/sum/8)" 0.02
is "as they were asked for" "$(grep -c 'repetitions=3' calls)" 1
holds "start of a tool" "$(json first.json median_ms.start/vam-none) > 0"
is "the load is said" "$(json first.json machine.load)" 0.1
TIMES='40 30 50' "$bench" --against first.json --only sum build >table
is "a ratio" "$(awk '/sum/ { print $4 }' table)" 2.000
is "only what is asked for" "$(grep -c start table)" 0

echo '2.50 0.20 0.30 1/100 1234' >load
fails 75 'bench: the machine is busy: load 2.50, above 0.3; wait a minute, or give --busy' "$bench" build
quiet "unless it may be" "$bench" --busy --only sum -o busy.json build
is "which is said" "$(json busy.json machine.load)" 2.5
mkdir bare
fails 66 'bare: has no .*_bench; build the preset release first' "$bench" --busy bare
echo '{' >broken.json
fails 65 'broken.json: is not what bench -o writes' "$bench" --busy --against broken.json build
TIMES=x; export TIMES
printf '#!/bin/sh\necho wrong >&2; exit 3\n' >build/some_bench
fails 1 'bench: some_bench: exit status 3: wrong' "$bench" --busy build
done_testing
