#include <algorithm>
#include <charconv>
#include <compare>
#include <system_error>
#include <utility>
#include <vector>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>

#include <spindrift/core/files.h>
#include <spindrift/core/text.h>
#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/fields.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/scene_rules.h>

#include "scene_parts.h"

namespace spindrift::scene {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::TextFormat;

/// Maximum number of errors in a report; bounds the report for hostile input.
constexpr std::size_t kMaxReportedErrorCount = 100;
/// One more than reported shows that there are more. Bounded, because finding the location of an error reads the text
/// from its start.
constexpr std::size_t kMaxKeptErrorCount = kMaxReportedErrorCount + 1;
/// Maximum nesting of braces; a scene needs four.
constexpr int kMaxNestingDepth = 32;
/// Maximum length of one error in a report: it may quote a word of the file.
constexpr std::size_t kMaxErrorBytes = 1000;

/// Zero-based, as in Protobuf.
struct Location {
  int line = 0;
  int column = 0;
  auto operator<=>(const Location&) const = default;
};

struct LocatedError {
  Location location;
  std::string message;
};

/// Returns the location behind a character as Protobuf's tokenizer counts: bytes, with tab stops at multiples of 8.
Location behind(char c, Location at) {
  constexpr int kTabWidth = 8;
  if (c == '\n') return {at.line + 1, 0};
  return {at.line, c == '\t' ? at.column + kTabWidth - at.column % kTabWidth : at.column + 1};
}

Location locationOf(std::string_view text, std::size_t offset) {
  Location at;
  for (const char c : text.substr(0, offset)) at = behind(c, at);
  return at;
}

std::size_t offsetOf(std::string_view text, Location wanted) {
  Location at;
  std::size_t offset = 0;
  for (; offset < text.size() && at < wanted; ++offset) at = behind(text[offset], at);
  return offset;
}

/// Returns the true location of an error. Some errors are found only when the parser is already behind the quoted word,
/// possibly some lines later. The true location is the last occurrence of the word before that.
Location placeOf(std::string_view text, Location reported, std::string_view message) {
  for (const std::string_view phrase :
       {std::string_view("Unknown enumeration value of \""), std::string_view("has no field named \""),
        std::string_view("Non-repeated field \""), std::string_view("Value: \"")}) {
    const std::size_t found = message.rfind(phrase);
    if (found == std::string_view::npos) continue;
    std::string_view word = message.substr(found + phrase.size());
    word = word.substr(0, word.find('"'));
    const std::size_t offset = offsetOf(text, reported);
    if (word.empty() || offset == 0) return reported;
    const std::size_t place = text.rfind(word, offset - 1);
    return place == std::string_view::npos ? reported : locationOf(text, place);
  }
  return reported;
}

class ErrorCollector : public google::protobuf::io::ErrorCollector {
 public:
  ErrorCollector(std::string_view text, std::vector<LocatedError>& errors) : text_(text), errors_(errors) {}
  void AddError(int line, int column, const std::string& message) override {
    add(line, column, message);
    failed_line_ = errors_.back().location.line;
  }
  /// Unknown fields are reported as warnings, because the parser was told to continue after them.
  void AddWarning(int line, int column, const std::string& message) override {
    if (errors_.size() < kMaxKeptErrorCount) add(line, column, message);
  }
  int failedLine() const { return failed_line_; }

 private:
  void add(int line, int column, const std::string& message) {
    errors_.push_back({placeOf(text_, {std::max(line, 0), std::max(column, 0)}, message), message});
  }

  std::string_view text_;
  std::vector<LocatedError>& errors_;
  int failed_line_ = -1;
};

/// Blanks a line that contains only one "field: value" and no brackets, so that parsing can continue after it.
bool blankSimpleLine(std::string& text, int line) {
  const std::size_t begin = offsetOf(text, {line, 0});
  const std::size_t end = std::min(text.find('\n', begin), text.size());
  const std::string_view content(text.data() + begin, end - begin);
  const bool simple =
      content.find(':') != std::string_view::npos && content.find_first_of("{}<>[]") == std::string_view::npos;
  if (!simple) return false;
  text.replace(begin, end - begin, end - begin, ' ');
  return true;
}

/// The parser recurses for each brace. Braces in strings and comments are counted too, which is safe.
bool nestsTooDeep(std::string_view text) {
  int depth = 0;
  for (const char c : text) {
    if (c == '{' || c == '<' || c == '[') ++depth;
    if ((c == '}' || c == '>' || c == ']') && depth > 0) --depth;
    if (depth > kMaxNestingDepth) return true;
  }
  return false;
}

/// Parses as far as possible and collects every syntax error, unknown field and wrong type.
std::unique_ptr<TextFormat::ParseInfoTree> parseText(std::string text, v1::Scene& scene,
                                                     std::vector<LocatedError>& errors) {
  for (;;) {
    std::vector<LocatedError> found;
    ErrorCollector collector(text, found);
    auto tree = std::make_unique<TextFormat::ParseInfoTree>();
    TextFormat::Parser parser;
    parser.RecordErrorsTo(&collector);
    parser.AllowUnknownField(true);
    parser.WriteLocationsTo(tree.get());
    const bool parsed = parser.ParseFromString(text, &scene);
    // A later attempt reports the unknown fields of an earlier one again.
    for (LocatedError& error : found) {
      const bool known = std::ranges::any_of(errors, [&](const LocatedError& other) {
        return other.location.line == error.location.line && other.message == error.message;
      });
      if (!known) errors.push_back(std::move(error));
    }
    const bool give_up = errors.size() >= kMaxReportedErrorCount || collector.failedLine() < 0 ||
                         !blankSimpleLine(text, collector.failedLine());
    if (parsed || give_up) return tree;
  }
}

/// Returns the location of a path ("events[1].effect.splash") in the text; if the field was left out, that of its
/// innermost part.
Location locate(const TextFormat::ParseInfoTree& root, std::string_view path) {
  Location best;
  const TextFormat::ParseInfoTree* tree = &root;
  const Descriptor* type = v1::Scene::descriptor();
  while (tree != nullptr && type != nullptr && !path.empty()) {
    const std::string_view segment = path.substr(0, path.find('.'));
    path.remove_prefix(std::min(path.size(), segment.size() + 1));
    const std::size_t bracket = segment.find('[');
    const FieldDescriptor* field = type->FindFieldByName(std::string(segment.substr(0, bracket)));
    if (field == nullptr) break;
    int index = -1;
    if (bracket != std::string_view::npos) {
      std::from_chars(segment.data() + bracket + 1, segment.data() + segment.size(), index);
    }
    if (field->is_repeated() != (index >= 0)) break;
    const TextFormat::ParseLocation location = tree->GetLocation(field, index);
    if (location.line < 0) break;
    best = {location.line, location.column};
    type = field->message_type();
    tree = type != nullptr ? tree->GetTreeForNested(field, index) : nullptr;
  }
  return best;
}

std::string report(const std::string& file_label, std::vector<LocatedError> errors) {
  std::ranges::stable_sort(errors, {}, &LocatedError::location);
  std::string text;
  const std::size_t shown = std::min(errors.size(), kMaxReportedErrorCount);
  for (std::size_t i = 0; i < shown; ++i) {
    if (i > 0) text += '\n';
    text += file_label + ':' + std::to_string(errors[i].location.line + 1) + ':' +
            std::to_string(errors[i].location.column + 1) + ": " + core::quoteText(errors[i].message, kMaxErrorBytes);
  }
  if (errors.size() > shown) text += '\n' + file_label + ": and more; correct these first";
  return text;
}

/// Returns the reason why a name does not stay in the folder; empty if it does.
std::string leavesFolder(const std::filesystem::path& folder, const std::filesystem::path& name) {
  if (name.is_absolute()) return "is an absolute path";
  for (const std::filesystem::path& part : name) {
    if (part == "..") return "goes up by \"..\"";
  }
  // Links are followed: what they point to has to be in the folder, too.
  std::error_code error;
  const std::filesystem::path root =
      std::filesystem::weakly_canonical(folder.empty() ? std::filesystem::path(".") : folder, error);
  const std::filesystem::path file = std::filesystem::weakly_canonical(root / name, error);
  if (error) return "cannot be found: " + error.message();
  const std::filesystem::path inside = file.lexically_relative(root);
  return inside.empty() || *inside.begin() == ".." ? "is a link that leads out of it" : "";
}

}  // namespace

core::Result<std::filesystem::path> fileInFolder(const std::optional<std::filesystem::path>& folder,
                                                 const std::filesystem::path& name, const std::string& instead) {
  if (!folder) return core::invalid("cannot be read, because this scene is not a file; give " + instead + " instead");
  if (const std::string why = leavesFolder(*folder, name); !why.empty())
    return core::invalid(why + "; put the file into the folder of the scene file");
  return *folder / name;
}

core::Result<v1::Scene> parseSceneText(std::string_view text, const std::string& file_label,
                                       std::optional<v1::Fidelity> fidelity,
                                       const std::optional<std::filesystem::path>& folder) {
  if (text.size() > kSceneFileMaxBytes) {
    return core::invalid(file_label + ": " + std::to_string(text.size()) + " bytes are more than " +
                         std::to_string(kSceneFileMaxBytes) + "; a scene is a small text");
  }
  if (nestsTooDeep(text)) {
    return core::invalid(file_label + ": braces nest deeper than " + std::to_string(kMaxNestingDepth) +
                         "; a scene needs four levels");
  }
  v1::Scene scene;
  std::vector<LocatedError> errors;
  const auto tree = parseText(std::string(text), scene, errors);
  const bool text_is_fine = errors.empty();

  std::vector<FieldIssue> issues;
  checkFields(scene, "", issues);
  // A level rounds the width to its own cells.
  if (text_is_fine && issues.empty() && scene.has_wave()) checkCells(scene.wave(), issues);
  if (text_is_fine) {
    const bool numbers_are_fine = issues.empty();
    if (fidelity) scene.set_fidelity(*fidelity);
    if (numbers_are_fine) applyFidelity(scene);
    fillDefaults(scene);
    if (scene.name().empty()) scene.set_name(std::filesystem::path(file_label).stem().string());
    for (FieldIssue& issue : checkStructure(scene)) issues.push_back(std::move(issue));
    if (numbers_are_fine) {
      readSeries(scene, folder, issues);
      for (FieldIssue& issue : checkNumbers(scene)) issues.push_back(std::move(issue));
      if (scene.bed().has_grid()) readDepthGrid(*scene.mutable_bed()->mutable_grid(), folder, issues);
    }
  }
  for (FieldIssue& issue : issues) {
    errors.push_back({locate(*tree, issue.path), issue.path + ": " + issue.message});
  }
  if (!errors.empty()) return core::invalid(report(file_label, std::move(errors)));
  return scene;
}

core::Result<v1::Scene> loadSceneFile(const std::filesystem::path& file, std::optional<v1::Fidelity> fidelity) {
  const std::string label = file.string();
  const auto text = core::readText(file, kSceneFileMaxBytes, "a scene file", "a scene is a small text");
  if (!text) return core::Error{text.error().code, label + ": " + text.error().message};
  return parseSceneText(*text, label, fidelity, file.parent_path());
}

}  // namespace spindrift::scene
