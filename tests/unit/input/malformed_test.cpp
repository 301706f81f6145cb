// SPDX-License-Identifier: BSD-3-Clause
// Inputs that are wrong, one table: what each must be answered with. Every answer has to say where, what and
// what to do instead.
#include <gtest/gtest.h>

#include "input/reader.hpp"
#include "sample_parameters.hpp"

namespace rhexis::input {
namespace {

struct Case {
  const char* name;
  const char* text;                    ///< of the file a.toml
  std::vector<const char*> fragments;  ///< of the message
  std::vector<std::string> overrides = {};
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

class Malformed : public testing::TestWithParam<Case> {};

TEST_P(Malformed, IsAnsweredWithAReason) {
  const Case& wrong = GetParam();
  Sample sample;
  try {
    read(parse_document(wrong.text, "a.toml", wrong.overrides), sample.parameters());
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    for (const char* fragment : wrong.fragments)
      EXPECT_NE(message.find(fragment), std::string::npos) << "no '" << fragment << "' in: " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << "more than a paragraph: " << message;
  }
}

std::string name_of_case(const testing::TestParamInfo<Case>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(
    Syntax, Malformed,
    testing::Values(
        Case{"quotes_forgotten",
             "[vessel]\nlength = 20 mm\n",
             {"a.toml:2:", "not valid TOML", "goes in quotes"}},
        Case{"word_without_quotes",
             "[load]\nschedule = ramp\n",
             {"a.toml:2:", "not valid TOML", "goes in quotes"}},
        Case{"no_value", "[vessel]\nlength =\n", {"a.toml:2:", "not valid TOML"}},
        Case{"open_header", "[vessel\nlength = 1\n", {"a.toml:1:8", "not valid TOML", "']'"}},
        Case{"header_of_punctuation", "[}vessel]\n", {"a.toml:1:2: not valid TOML", "saw '}'"}},
        Case{"open_string", "[vessel]\nlength = \"1 mm\n", {"a.toml:2:", "not valid TOML"}},
        Case{"open_list", "[insitu]\nscripts = [\"a.py\"\n", {"a.toml:", "not valid TOML"}},
        Case{"not_utf8", "[vessel]\nlength = \"1 \xb5m\"\n", {"a.toml:2:", "not UTF-8"}},
        Case{"key_twice", "[time]\nend = \"1 s\"\nend = \"2 s\"\n", {"a.toml:3:", "defined twice", "'end'"}},
        Case{"section_twice", "[time]\n[load]\n[time]\n", {"a.toml:3:", "defined twice", "'time'"}},
        Case{"huge_integer", "[output]\nevery_steps = 99999999999999999999\n", {"a.toml:2:", "64 bits"}},
        Case{"nested",
             "[vessel.wall]\nlength = 1\n",
             {"a.toml:1", "unexpected table 'vessel.wall'", "no deeper"}},
        Case{"nested_inline",
             "[vessel]\nlength = {x = 1}\n",
             {"a.toml:2", "unexpected table 'vessel.length'"}},
        Case{"list_of_sections", "[[vessel]]\n", {"a.toml:1", "[[vessel]]", "write [vessel]"}},
        Case{"list_of_tables", "[load]\ntable = [1, {x = 1}]\n", {"a.toml:2", "load.table", "no key takes"}},
        Case{"date", "[time]\nend = 1979-05-27\n", {"a.toml:2", "time.end", "no dates"}},
        Case{"dot_in_quotes",
             "\"vessel.length\" = \"1 mm\"\n",
             {"a.toml:1", "\"vessel.length\"", "letters, digits"}},
        Case{"line_break_in_a_name",
             "[vessel]\n\"a\\nb\" = 1\n",
             {"a.toml:2", "\"a\\nb\"", "letters, digits"}},
        Case{"letter_beyond_ascii",
             "[vessel]\n# \u00e9\nlength = \"1 mm\"\n\u00e9length = \"2.5 mm\"\n",
             {"a.toml:4:1: not valid TOML", "'\u00e9' outside of quotes"}},
        Case{"value_beyond_ascii",
             "[scene]\nlength = \u0436\n",
             {"a.toml:2:10:", "'\u0436' outside of quotes"}},
        Case{"not_utf8_in_a_name", "[vessel]\nl\xe9ngth = 1\n", {"a.toml:2:", "not UTF-8"}},
        Case{"nul_in_a_text",
             "[vessel]\nlength = \"1 mm\\u0000\"\n",
             {"a.toml:2: vessel.length", "control character"}},
        Case{"line_break_in_a_list",
             "[insitu]\nscripts = [\"a.py\", \"b\\nc.py\"]\n",
             {"a.toml:2: insitu.scripts", "control character"}},
        Case{"long_name",
             "[vessel]"
             "\naaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa = "
             "1\n",
             {"a.toml:2", "at most 80", "..."}},
        Case{"hint_only_where_it_helps",
             "[vessel\n",
             {"a.toml:1:8: not valid TOML: expected ']', saw '\\n'"}}),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    Keys, Malformed,
    testing::Values(
        Case{"misspelt_key",
             "[vessel]\niner_radius = \"1 mm\"\n",
             {"a.toml:2: vessel.iner_radius = \"1 mm\"", "no such key", "did you mean vessel.inner_radius?"}},
        Case{"swapped_letters", "[time]\nned = \"1 ms\"\n", {"a.toml:2", "did you mean time.end?"}},
        Case{"part_of_a_name", "[material]\nstretch = 1\n", {"did you mean material.critical_stretch?"}},
        Case{"other_section", "[vessel]\ndensity = 1\n", {"a.toml:2", "did you mean material.density?"}},
        Case{"no_such_key", "[vessel]\nqqqq = 1\n", {"a.toml:2: vessel.qqqq = 1", "rhexis keys vessel"}},
        Case{"no_section",
             "length = \"1 mm\"\n",
             {"a.toml:1: length", "stands in a section", "mean vessel.length?"}},
        Case{"unknown_section",
             "[vesel]\nlength = \"1 mm\"\n",
             {"a.toml:1: [vesel]", "no section 'vesel'", "did you mean vessel?", "material, discretisation"}},
        Case{"empty_unknown_section",
             "[solver]\n",
             {"a.toml:1: [solver]", "no section 'solver'", "sections: vessel"}},
        Case{"empty_file",
             "",
             {"a.toml: vessel.inner_radius is missing", "[vessel]", "inner_radius = \"1.5 mm\"", "length [m]",
              "greater than 0 m", "Inner radius before loading."}},
        Case{"unknown_before_missing", "[time]\nstpe = 1\n", {"a.toml:2", "did you mean time.step?"}},
        Case{"first_in_the_file", "[time]\nend = 1\n[vessel]\nlength = 2\n", {"a.toml:2: time.end = 1"}}),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    Numbers, Malformed,
    testing::Values(
        Case{"unit_missing",
             "\n[vessel]\ninner_radius = \"1.5\"\n",
             {"a.toml:3: vessel.inner_radius = \"1.5\": a unit is missing; write for example \"1.5 m\" or "
              "\"1.5 mm\" or \"1.5 um\"",
              "(allowed: greater than 0 m)"}},
        Case{"number_without_unit",
             "[vessel]\nlength = 20\n",
             {"a.toml:2: vessel.length = 20: a unit is missing", "\"20 mm\"",
              "greater than 0 m and at most 1 m"}},
        Case{"wrong_dimension",
             "[load]\npressure = \"238 kg\"\n",
             {"a.toml:2: load.pressure = \"238 kg\"", "measures a mass", "a pressure is expected",
              "238 mmHg"}},
        Case{"unknown_unit",
             "[load]\npressure = \"2 kpa\"\n",
             {"a.toml:2", "'kpa' is not a known unit", "2 kPa"}},
        Case{"text_after_a_nul", "[time]\nend = \"1 s\\u0000kg\"\n", {"a.toml:2", "control character"}},
        Case{"no_number", "[time]\nend = \"soon\"\n", {"a.toml:2: time.end = \"soon\"", "number", "500 ns"}},
        Case{"negative",
             "[vessel]\ninner_radius = \"-1.5 mm\"\n",
             {"a.toml:2: vessel.inner_radius = \"-1.5 mm\": must be greater than 0 m; this is -0.0015 m"}},
        Case{"zero_at_an_open_end",
             "[vessel]\nlength = \"0 mm\"\n",
             {"must be greater than 0 m and at most 1 m"}},
        Case{"too_long",
             "[vessel]\nlength = \"2 km\"\n",
             {"vessel.length = \"2 km\"", "at most 1 m", "2000 m"}},
        Case{"plain_out_of_range",
             "[material]\ncritical_stretch = 10\n",
             {"a.toml:2: material.critical_stretch = 10: must be greater than 0 and less than 10"}},
        Case{"not_a_number",
             "[material]\ncritical_stretch = nan\n",
             {"a.toml:2", "= nan: not a finite number"}},
        Case{"infinite", "[material]\ncritical_stretch = inf\n", {"a.toml:2", "= inf: not a finite number"}},
        Case{"unit_for_a_plain_number",
             "[material]\ncritical_stretch = \"1 m\"\n",
             {"'m' measures a length", "a plain number is expected", "25 %", "less than 10"}},
        Case{"flag_for_a_number", "[time]\nend = true\n", {"time.end = true: a time is expected", "500 ns"}},
        Case{"list_for_a_number", "[time]\nend = [\"1 s\"]\n", {"time.end = [\"1 s\"]: a time is expected"}},
        Case{"no_auto_here",
             "[time]\nend = \"auto\"\n",
             {"a.toml:2: time.end", "no \"auto\"", "a time is expected"}},
        Case{"nearly_auto",
             "[time]\nstep = \"atuo\"\n",
             {"a.toml:2: time.step", "greater than 0 s, or \"auto\""}},
        Case{"fraction",
             "[output]\nevery_steps = 1.5\n",
             {"a.toml:2: output.every_steps = 1.5: a whole number is expected", "at least 1"}},
        Case{"quoted_integer",
             "[output]\nevery_steps = \"10\"\n",
             {"a whole number is expected, without quotes"}},
        Case{"integer_too_small",
             "[output]\nevery_steps = 0\n",
             {"output.every_steps = 0: must be at least 1"}},
        Case{"optional_integer",
             "[discretisation]\nparticles = \"many\"\n",
             {"a whole number", "or \"auto\""}},
        Case{"optional_out_of_range", "[discretisation]\nspacing = \"0 m\"\n", {"must be greater than 0 m"}}),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    TextsAndLists, Malformed,
    testing::Values(
        Case{"no_such_choice",
             "[load]\nschedule = \"smoth_ramp\"\n",
             {"a.toml:2: load.schedule = \"smoth_ramp\": not one of the choices",
              "did you mean \"smooth_ramp\"?", "allowed: \"step\", \"ramp\", \"smooth_ramp\", \"table\""}},
        Case{"swapped_letters_of_a_choice", "[load]\nschedule = \"rmap\"\n", {"did you mean \"ramp\"?"}},
        Case{"number_for_a_text",
             "[load]\nschedule = 3\n",
             {"a.toml:2", "a text in quotes is expected", "\"ramp\""}},
        Case{
            "flag_in_quotes", "[insitu]\nmovie = \"yes\"\n", {"a.toml:2", "true or false", "without quotes"}},
        Case{"text_for_a_list",
             "[insitu]\nscripts = \"a.py\"\n",
             {"a.toml:2", "a list is expected", "[\"text\"]"}},
        Case{"wrong_element",
             "[output]\nfields = [\"damage\", \"velocty\"]\n",
             {"a.toml:2: output.fields", "element 2, \"velocty\"", "did you mean \"velocity\"?"}},
        Case{"number_among_texts",
             "[insitu]\nscripts = [\"a.py\", 3]\n",
             {"element 2, 3", "a text in quotes"}},
        Case{"element_without_unit",
             "[output]\nprobes = [\"1 mm\", 2]\n",
             {"element 2, 2", "a unit is missing"}},
        Case{"element_out_of_range",
             "[output]\nprobes = [\"-1 mm\"]\n",
             {"element 1, \"-1 mm\"", "at least 0 m"}},
        Case{"flat_curve",
             "[load]\ntable = [\"0 s\", \"1 Pa\"]\n",
             {"element 1, \"0 s\"", "a list of two values"}},
        Case{"point_of_three",
             "[load]\ntable = [[\"0 s\", \"1 Pa\", 3]]\n",
             {"element 1", "list of two values"}},
        Case{
            "curve_units_swapped",
            "[load]\ntable = [[\"0 s\", \"1 Pa\"], [\"1 Pa\", \"1 s\"]]\n",
            {"a.toml:2", "element 2, [\"1 Pa\", \"1 s\"]", "'Pa' measures a pressure", "a time is expected"}},
        Case{"curve_out_of_range", "[load]\ntable = [[\"-1 s\", \"1 Pa\"]]\n", {"must be at least 0 s"}}),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    Overrides, Malformed,
    testing::Values(
        Case{"without_equals", "", {"--set vessel.length", "section.name=value"}, {"vessel.length"}},
        Case{"without_key", "", {"--set =3", "section.name=value"}, {"=3"}},
        Case{"without_value", "", {"--set time.end=: a value is missing"}, {"time.end="}},
        Case{"override_without_unit",
             "",
             {"--set time.end=500: a unit is missing", "\"500 ns\""},
             {"time.end=500"}},
        Case{
            "override_of_unknown_key", "", {"--set time.stop=1", "did you mean time.step?"}, {"time.stop=1"}},
        Case{"override_in_unknown_section",
             "",
             {"did you mean vessel.length?", "sections:"},
             {"vesel.lenght=1"}},
        Case{"quotes_lost_in_the_shell",
             "",
             {"--set insitu.scripts=[a.py]", "single quotes"},
             {"insitu.scripts=[a.py]"}},
        Case{"whole_table", "", {"--set vessel={length", "not a valid value"}, {"vessel={length=\"1 mm\"}"}},
        Case{"line_break", "", {"--set load.schedule=a b", "control character"}, {"load.schedule=a\nb"}},
        Case{"override_not_utf8", "", {"--set load.schedule=", "not UTF-8"}, {"load.schedule=\xb5"}},
        Case{"good_override_hides_a_bad_value",
             "[time]\nend = 3\n",
             {"vessel.inner_radius is missing"},
             {"time.end=3 ms"}}),
    name_of_case);

}  // namespace
}  // namespace rhexis::input
