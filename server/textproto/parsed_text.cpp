#include <algorithm>
#include <charconv>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/tokenizer.h>

#include <spindrift/core/text.h>
#include <spindrift/textproto/parsed_text.h>

namespace spindrift::textproto {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::TextFormat;

/// Maximum number of errors in a report; bounds the report for hostile input.
constexpr std::size_t kMaxReportedErrorCount = 100;
/// One more than reported shows that there are more. Bounded, because finding the location of an error reads the text
/// from its start.
constexpr std::size_t kMaxKeptErrorCount = kMaxReportedErrorCount + 1;
constexpr int kMaxNestingDepth = 32;
/// Maximum length of one error in a report: it may quote a word of the file.
constexpr std::size_t kMaxErrorBytes = 1000;

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

constexpr std::string_view kUnknownField = "has no field named \"";
constexpr std::string_view kUnknownValue = "Unknown enumeration value of \"";

/// Returns the word that `message` quotes behind a phrase of it; empty: it does not have the phrase.
std::string_view quotedBehind(std::string_view message, std::string_view phrase) {
  const std::size_t found = message.rfind(phrase);
  if (found == std::string_view::npos) return {};
  const std::string_view word = message.substr(found + phrase.size());
  return word.substr(0, word.find('"'));
}

/// Returns the true location of an error. Some errors are found only when the parser is already behind the quoted word,
/// possibly some lines later. The true location is the last occurrence of the word before that.
Location placeOf(std::string_view text, Location reported, std::string_view message) {
  for (const std::string_view phrase :
       {kUnknownValue, kUnknownField, std::string_view("Non-repeated field \""), std::string_view("Value: \"")}) {
    const std::string_view word = quotedBehind(message, phrase);
    const std::size_t offset = word.empty() ? 0 : offsetOf(text, reported);
    if (offset == 0) continue;
    const std::size_t place = text.rfind(word, offset - 1);
    return place == std::string_view::npos ? reported : locationOf(text, place);
  }
  return reported;
}

/// Collects the enumerations of fields with this name in `type` and below it.
void collectEnums(const Descriptor& type, std::string_view field_name, std::set<const Descriptor*>& visited,
                  std::vector<const EnumDescriptor*>& found) {
  if (!visited.insert(&type).second) return;
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (field.message_type() != nullptr) collectEnums(*field.message_type(), field_name, visited, found);
    if (field.enum_type() != nullptr && field.name() == field_name && std::ranges::count(found, field.enum_type()) == 0)
      found.push_back(field.enum_type());
  }
}

/// Returns the values that the enumeration of an error has, as a part of a sentence; empty for other errors.
std::string knownValues(const Descriptor& root, std::string_view message) {
  if (quotedBehind(message, kUnknownValue).empty()) return "";
  std::set<const Descriptor*> visited;
  std::vector<const EnumDescriptor*> enums;
  collectEnums(root, quotedBehind(message, "for field \""), visited, enums);
  std::string text;
  for (const EnumDescriptor* const values : enums)
    for (int i = 0; i < values->value_count(); ++i)
      if (!values->value(i)->name().ends_with("_UNSPECIFIED"))
        text += (text.empty() ? " Write " : ", ") + values->value(i)->name();
  return text.empty() ? text : text + '.';
}

/// Returns the fields of the message that lacks one, as a sentence; empty for other errors.
std::string knownFields(const Descriptor& root, std::string_view message) {
  if (quotedBehind(message, kUnknownField).empty()) return "";
  const std::string name(quotedBehind(message, "Message type \""));
  const Descriptor* const type = root.file()->pool()->FindMessageTypeByName(name);
  std::string text;
  for (int i = 0; type != nullptr && i < type->field_count(); ++i)
    text += (text.empty() ? " Its fields are " : ", ") + type->field(i)->name();
  return text.empty() ? text : text + '.';
}

class ErrorCollector : public google::protobuf::io::ErrorCollector {
 public:
  ErrorCollector(std::string_view text, const Descriptor& root, std::vector<LocatedError>& errors)
      : text_(text), root_(root), errors_(errors) {}
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
    errors_.push_back({placeOf(text_, {std::max(line, 0), std::max(column, 0)}, message),
                       message + knownValues(root_, message) + knownFields(root_, message)});
  }

  std::string_view text_;
  const Descriptor& root_;
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

}  // namespace

ParsedText::ParsedText(std::string text, google::protobuf::Message& message) : type_(message.GetDescriptor()) {
  if (nestsTooDeep(text)) {
    errors_.push_back(
        {{}, fmt::format("braces nest deeper than {}; look for a brace that is not closed", kMaxNestingDepth)});
    return;
  }
  for (;;) {
    std::vector<LocatedError> found;
    ErrorCollector collector(text, *type_, found);
    tree_ = std::make_unique<TextFormat::ParseInfoTree>();
    TextFormat::Parser parser;
    parser.RecordErrorsTo(&collector);
    parser.AllowUnknownField(true);
    parser.WriteLocationsTo(tree_.get());
    const bool parsed = parser.ParseFromString(text, &message);
    // A later attempt reports the unknown fields of an earlier one again.
    for (LocatedError& error : found) {
      const bool known = std::ranges::any_of(errors_, [&](const LocatedError& other) {
        return other.location.line == error.location.line && other.message == error.message;
      });
      if (!known) errors_.push_back(std::move(error));
    }
    const bool give_up = errors_.size() >= kMaxReportedErrorCount || collector.failedLine() < 0 ||
                         !blankSimpleLine(text, collector.failedLine());
    if (parsed || give_up) return;
  }
}

void ParsedText::addError(std::string_view path, std::string_view message) {
  errors_.push_back({locate(path), fmt::format("{}: {}", path, message)});
}

Location ParsedText::locate(std::string_view path) const {
  Location best;
  const TextFormat::ParseInfoTree* tree = tree_.get();
  const Descriptor* type = type_;
  while (tree != nullptr && type != nullptr && !path.empty()) {
    const std::string_view segment = path.substr(0, path.find('.'));
    path.remove_prefix(std::min(path.size(), segment.size() + 1));
    const std::size_t bracket = segment.find('[');
    const FieldDescriptor* field = type->FindFieldByName(std::string(segment.substr(0, bracket)));
    if (field == nullptr) break;
    int index = -1;
    if (bracket != std::string_view::npos)
      std::from_chars(segment.data() + bracket + 1, segment.data() + segment.size(), index);
    if (field->is_repeated() != (index >= 0)) break;
    const TextFormat::ParseLocation location = tree->GetLocation(field, index);
    if (location.line < 0) break;
    best = {location.line, location.column};
    type = field->message_type();
    tree = type != nullptr ? tree->GetTreeForNested(field, index) : nullptr;
  }
  return best;
}

std::string ParsedText::report(const std::string& label) const {
  std::vector<LocatedError> errors = errors_;
  std::ranges::stable_sort(errors, {}, &LocatedError::location);
  std::string text;
  const std::size_t shown = std::min(errors.size(), kMaxReportedErrorCount);
  for (const auto& [location, message] : std::span(errors).first(shown))
    text += fmt::format("{}{}:{}:{}: {}", text.empty() ? "" : "\n", label, location.line + 1, location.column + 1,
                        core::quoteText(message, kMaxErrorBytes));
  if (errors.size() > shown) text += '\n' + label + ": and more; correct these first";
  return text;
}

}  // namespace spindrift::textproto
