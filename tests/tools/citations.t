# SPDX-License-Identifier: GPL-3.0-or-later
# What the source cites stands in the manual pages of section 7; and the check that verifies it finds what does not.
. "$VAM_SOURCE/tests/tools/testlib.sh"

check() { python3 "$VAM_SOURCE/tests/tools/citations.py" "$1"; }
ok "every citation, attribute, printer key, schema and key of a report is in the manual" check "$VAM_SOURCE"

mkdir tree
for part in CONTRIBUTING.md man lib tools scripts tests; do cp -r "$VAM_SOURCE/$part" tree; done
finds() {  # finds REGEX TEXT: a source file with this text has this fault and no other; judged by all_found
  number_of_text=$((number_of_text + 1))
  printf '%s\n' "$2" >"tree/lib/base/cited_$number_of_text.hpp"
  printf '%s\n' "$1" >"wanted_$number_of_text"
}
number_of_text=0
all_found() {
  cat >tree/lib/base/cited.hpp <<'TEXT'
    {"projector", "colour", at<&Printer::projector>},
    schema = "vam-dose/3";
TEXT
  sed -i 's|^    {"volume", 1},|&\n    {"vam-paint", 1},|' tree/lib/base/text/format_version.hpp
  check tree >faults && report 1 'the check finds faults'
  for n in $(seq $number_of_text); do
    file=tree/lib/base/cited_$n.hpp
    grep "^lib/base/cited_$n.hpp: " faults >here
    is "found: $(cat "$file")" "$(wc -l <here):$(grep -Ec -f "wanted_$n" here)" 1:1
    rm "$file"
  done
  for wanted in "the printer file's projector.colour is missing" 'version 1 of vam-paint is missing' 'no version 3 of vam-dose'; do
    is "found: $wanted" "$(grep -Ec "^(man|lib)/.*$wanted" faults)" 1
  done
  is 'and nothing else' "$(wc -l <faults)" $((number_of_text + 3))
}
finds 'names lost_ray.cpp, which does not exist' '// as in lost_ray.cpp'
finds 'vam-physics.7. has no section 99' '// along the ray [physics §2, §99]'
finds '"physics section 4" is to be written' '// the dose of physics section 4'
finds '"vam-physics.7. section 4" is to be written' '// the dose, see vam-physics(7) section 4'
finds 'vam-devices.7. has no section 99' '// as [devices §99] has it'
finds '.physics 99. is no form' '// along the ray [physics 99]'
finds '.physics § 99. is no form' '// along the ray [physics § 99]'
finds '"physics, sec. 99" is to be written' '// along the ray, physics, sec. 99'
finds '"§" is to be written' '// along the ray, §4'
finds 'vam-devices.7. has no guarantee 99' '// [devices guarantee 99]'
finds 'vam-devices.7. has no guarantee 9' '// [devices guarantees 1 and 9]'
finds '"guarantees 1" is to be written' '// guarantees 1-9'
finds '"promise 9" is to be written' '// promise 9'
finds '"slip 1" is to be written' '// slip 1'
finds '.RAY21 eq 8, 99. is no form' '// as in [RAY21 eq 8, 99]'
finds '.RAY21 eqs 4 and 5. is no form' '// as in [RAY21 eqs 4 and 5]'
finds '.RAY21 eq 98. does not stand' '// as in [RAY21 below eq 98]'
finds '.RAY21 fig 99. does not stand' '// as in [RAY21 fig 99]'
finds '.FDK. is not among the references' '// as in [FDK]'
finds '.FDK. is not among the references' '/// as in [FDK, the weights]'
finds '.formats X. is no form' '// as it is written [formats X]'
finds 'the attribute vam:Nonsense is not defined' 'const char* key = "vam:Nonsense";'
finds 'the key "paint_mm" is not defined' '  Json report; report.emplace("paint_mm", 2);'
finds 'the key "paint_mm" is not defined' '  Json report; report.push_back({"paint_mm", 2});'
finds '.KELLY99. is not among the references' '// as in [KELLY99]'
finds '.RAY21 eq 77. does not stand' '// as in [RAY21 eq 77]'
finds 'the attribute vam:colour is not defined' 'const char* key = "vam:colour";'
finds 'has no heading "weather"' '// as it is written [formats: weather]'
finds 'the key "paint_mm" is not defined' '  Json report{{"turns", 1}, {"paint_mm", 2}};'
finds 'the key "paint_mm" is not defined' '  Json report; report["repair"]["paint_mm"] = 2;'
finds 'the key "paint_mm" is not defined' '  finding.value("paint_mm", found, "mm", "fit"); Json facts;'
finds '"Kelvin, 1887" is to be cited by its key' '// cells of even faces (Kelvin, 1887)'
finds '"Kelvin et al" is to be cited by its key' '// cells of even faces, Kelvin et al.'
all_found
sed -i 's/^MethodEntry minimax_method();/MethodEntry minimax();/' tree/lib/optimize/methods/methods.cpp
rm -r tree/lib/resin tree/lib/base/cited.hpp tree/scripts/update-man
printf '(vam-physics(7), sections 4 and 99)\n.Xr vam-devices 7 ,\nsection 98\n' >>tree/man/vam-dose.1
check tree >faults
grep -q 'nothing in lib cites .CURE19 eq 5.' faults
report $? 'found: an equation that no source cites'
grep -q 'a recipe changes "MethodEntry minimax_method();"' faults
report $? 'found: a recipe that does not apply'
is 'found: sections that are not there, named by a page' "$(grep -Ec 'man/vam-dose.1: vam-(physics|devices)\(7\) has no section 9[89]$' faults)" 2
grep -q 'CONTRIBUTING.md: there is no scripts/update-man' faults
report $? 'found: a path that is not there'
done_testing
