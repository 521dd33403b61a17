#include <string>
#include <string_view>

#include <fmt/format.h>

#include <spindrift/core/text.h>
#include <spindrift/script/junit.h>

namespace spindrift::script {
namespace {

/// Returns the text for the content or an attribute of XML 1.0, which has no form for most control characters.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : core::toValidUtf8(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\n':
      case '\t':
        out += ' ';
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? '?' : c;
    }
  }
  return out;
}

std::string property(std::string_view name, const std::string& value) {
  return fmt::format("      <property name=\"{}\" value=\"{}\"/>\n", name, escaped(value));
}

std::string propertiesOf(const ScriptReport& report) {
  if (!report.held) return "";
  const HeldReport& held = *report.held;
  std::string out = "    <properties>\n";
  if (held.state_hash) out += property("state_hash", hashText(*held.state_hash));
  out += property("seed", std::to_string(held.seed)) + property("ticks", std::to_string(held.tick_count)) +
         property("watchdog", std::to_string(held.recovered_count));
  return out + "    </properties>\n";
}

std::string caseOf(const StepReport& step, const std::string& suite) {
  const std::string name = fmt::format("{} {}{}", step.index, step.what, step.note.empty() ? "" : ": " + step.note);
  std::string out = fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"", escaped(suite),
                                escaped(name), step.took_s);
  if (step.passed) return out + "/>\n";
  const std::string detail = escaped(fmt::format("{}: {}", step.client, step.detail));
  return out + fmt::format(">\n      <failure message=\"{}\">{}</failure>\n    </testcase>\n", detail, detail);
}

}  // namespace

std::string hashText(std::uint64_t hash) {
  return fmt::format("0x{:016x}", hash);
}

std::string toJunit(const ScriptReport& report, const std::string& name) {
  std::string cases;
  int failed_count = 0;
  double took_s = 0.0;
  for (const StepReport& step : report.steps) {
    cases += caseOf(step, name);
    failed_count += step.passed ? 0 : 1;
    took_s += step.took_s;
  }
  const int skipped_count = report.step_count - static_cast<int>(report.steps.size());
  for (int k = report.step_count - skipped_count; k < report.step_count; ++k) {
    cases += fmt::format(
        "    <testcase classname=\"{}\" name=\"{}\"><skipped message=\"an earlier step failed\"/></testcase>\n",
        escaped(name), k);
  }
  const std::string counts = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\" time=\"{:.3f}\"",
                                         report.step_count, failed_count, skipped_count, took_s);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {}>\n  <testsuite name=\"{}\" {}>\n{}{}  "
      "</testsuite>\n</testsuites>\n",
      counts, escaped(name), counts, propertiesOf(report), cases);
}

}  // namespace spindrift::script
