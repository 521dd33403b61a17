#include "json_check.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <spindrift/core/text.h>

namespace spindrift::wire {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

/// Maximum length of a name in error messages.
constexpr std::size_t kEchoMaxBytes = 64;

enum class Kind { kObject, kArray, kString, kNumber, kBoolean, kNull };

constexpr std::string_view kDigits = "0123456789", kHexDigits = "0123456789abcdefABCDEF", kSpace = " \t\n\r";

const FieldDescriptor* fieldOf(const Descriptor& type, const std::string& name) {
  if (const FieldDescriptor* field = type.FindFieldByName(name)) return field;
  for (int i = 0; i < type.field_count(); ++i) {
    if (type.field(i)->json_name() == name) return type.field(i);
  }
  return nullptr;
}

/// Returns what the field accepts, in words; empty if it accepts a value of this kind. Null counts as "left out"
/// everywhere. The field is not repeated, or the value is an element.
std::string wantedBy(const FieldDescriptor& field, Kind kind) {
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return kind == Kind::kObject ? "" : "an object {...}";
    case FieldDescriptor::CPPTYPE_STRING:
      return kind == Kind::kString ? "" : "a string";
    case FieldDescriptor::CPPTYPE_BOOL:
      return kind == Kind::kBoolean || kind == Kind::kString ? "" : "true or false";
    case FieldDescriptor::CPPTYPE_ENUM:
      return kind == Kind::kString || kind == Kind::kNumber ? "" : "the name of a value";
    default:
      return kind == Kind::kNumber || kind == Kind::kString ? "" : "a number";
  }
}

/// Recursive descent parser for the grammar of RFC 8259. Each read...() returns false after the first error, which is
/// kept.
class Checker {
 public:
  explicit Checker(std::string_view text) : text_(text) {}

  std::optional<std::string> check(const Descriptor& type) {
    skipSpace();
    if (at_ == text_.size()) return "it is empty; send a JSON object {...}";
    if (text_[at_] != '{') {
      (void)fail("a JSON object {...} is expected");
    } else if (readObject(&type, "", 1)) {
      skipSpace();
      if (at_ < text_.size()) (void)fail("nothing is expected behind the object");
    }
    return error_.empty() ? std::nullopt : std::optional(error_);
  }

 private:
  bool fail(const std::string& what) {
    const std::string_view before = text_.substr(0, at_);
    const auto line = std::ranges::count(before, '\n') + 1;
    const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
    error_ = "line " + std::to_string(line) + ", column " + std::to_string(at_ - line_begin + 1) + ": " + what;
    if (at_ == text_.size()) {
      error_ += ", and the text ends";
    } else {
      // One character, or one byte that belongs to none: a byte order mark is to be seen.
      constexpr std::size_t kEscapeMaxBytes = 16;
      const std::size_t length = std::max<std::size_t>(core::utf8SequenceLength(text_, at_), 1);
      error_ += ", not " + core::quoteText(text_.substr(at_, length), kEscapeMaxBytes);
    }
    return false;
  }
  bool failField(const std::string& path, const std::string& what) {
    error_ = path + ": " + what;
    return false;
  }

  void skipSpace() {
    while (isAt(kSpace)) ++at_;
  }
  /// Returns whether one of these characters is next.
  [[nodiscard]] bool isAt(std::string_view characters) const {
    return at_ < text_.size() && characters.find(text_[at_]) != std::string_view::npos;
  }
  bool take(char c) {
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  /// Returns the kind of the value that begins here; nullopt if none does.
  [[nodiscard]] std::optional<Kind> kindHere() const {
    if (at_ == text_.size()) return std::nullopt;
    const char c = text_[at_];
    if (c == '-' || isAt(kDigits)) return Kind::kNumber;
    constexpr std::pair<char, Kind> kKinds[] = {{'{', Kind::kObject},  {'[', Kind::kArray},   {'"', Kind::kString},
                                                {'t', Kind::kBoolean}, {'f', Kind::kBoolean}, {'n', Kind::kNull}};
    for (const auto& [first, kind] : kKinds) {
      if (c == first) return kind;
    }
    return std::nullopt;
  }

  /// `field` null: any value is accepted. `is_element`: element of a repeated field.
  bool readValue(const FieldDescriptor* field, bool is_element, const std::string& path, std::size_t depth) {
    const auto kind = kindHere();
    if (!kind) return fail("a value is expected");
    if (field != nullptr && *kind != Kind::kNull) {
      const std::string wanted =
          field->is_repeated() && !is_element ? (*kind == Kind::kArray ? "" : "a list [...]") : wantedBy(*field, *kind);
      if (!wanted.empty()) return failField(path, "has to be " + wanted);
    }
    switch (*kind) {
      case Kind::kObject:
        return readObject(field != nullptr ? field->message_type() : nullptr, path, depth);
      case Kind::kArray:
        return readArray(field, path, depth);
      case Kind::kString: {
        std::string unused;
        return readString(unused);
      }
      case Kind::kNumber:
        return readNumber();
      case Kind::kBoolean:
        return readWord(text_[at_] == 't' ? "true" : "false");
      case Kind::kNull:
        break;
    }
    return readWord("null");
  }

  /// Reads what lies between two brackets: items, each by `readItem`, with commas between them.
  template <typename ReadItem>
  bool readItems(char end, std::size_t depth, ReadItem readItem) {
    if (depth > kJsonMaxDepth) return fail("at most " + std::to_string(kJsonMaxDepth) + " values within one another");
    ++at_;  // the first bracket
    skipSpace();
    if (take(end)) return true;
    while (true) {
      if (!readItem()) return false;
      skipSpace();
      if (take(end)) return true;
      if (!take(',')) return fail(std::string("a comma or ") + end + " is expected");
      skipSpace();
    }
  }

  bool readObject(const Descriptor* type, const std::string& path, std::size_t depth) {
    // The field set in each oneof (an optional field is a oneof of its own).
    std::vector<std::pair<const google::protobuf::OneofDescriptor*, std::string>> chosen;
    std::vector<const FieldDescriptor*> known;
    return readItems('}', depth, [&] {
      if (!isAt("\"")) return fail("a name in double quotes is expected");
      std::string name;
      if (!readString(name)) return false;
      skipSpace();
      if (!take(':')) return fail("a colon is expected");
      skipSpace();
      const FieldDescriptor* field = nullptr;
      const std::string member_path = (path.empty() ? "" : path + ".") + core::cleanText(name, kEchoMaxBytes);
      if (type != nullptr) {
        field = fieldOf(*type, name);
        if (field == nullptr) return failField(member_path, type->name() + " has no such field");
        // Protobuf would take the last one.
        if (std::ranges::find(known, field) != known.end()) return failField(member_path, "is given twice");
        known.push_back(field);
        const bool is_null = kindHere() == Kind::kNull;
        if (const auto* choice = field->containing_oneof(); choice != nullptr && !is_null) {
          const auto other = std::ranges::find(chosen, choice, [](const auto& entry) { return entry.first; });
          if (other != chosen.end()) return failField(member_path, "cannot be given together with " + other->second);
          chosen.emplace_back(choice, field->name());
        }
      }
      return readValue(field, false, member_path, depth + 1);
    });
  }

  bool readArray(const FieldDescriptor* field, const std::string& path, std::size_t depth) {
    return readItems(']', depth, [&, index = std::size_t{0}]() mutable {
      return readValue(field, true, path + "[" + std::to_string(index++) + "]", depth + 1);
    });
  }

  /// `out`: the characters, without those from \u escapes, which no field name needs.
  bool readString(std::string& out) {
    ++at_;  // "
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"') {
        ++at_;
        return true;
      }
      if (static_cast<unsigned char>(c) < 0x20) return fail("control characters in a string have to be escaped");
      if (c == '\\') {
        if (!readEscape(out)) return false;
        continue;
      }
      const std::size_t length = core::utf8SequenceLength(text_, at_);
      if (length == 0) return fail("the text has to be UTF-8");
      out.append(text_.substr(at_, length));
      at_ += length;
    }
    return fail("a closing double quote is expected");
  }
  bool readEscape(std::string& out) {
    ++at_;  // backslash
    constexpr std::string_view kLetters = "\"\\/bfnrt";
    if (isAt(kLetters)) {
      out.push_back(text_[at_++]);
      return true;
    }
    if (!take('u')) return fail("one of \" \\ / b f n r t u is expected behind a backslash");
    for (int k = 0; k < 4; ++k, ++at_) {
      if (!isAt(kHexDigits)) return fail("four hexadecimal digits are expected behind \\u");
    }
    return true;
  }
  bool readDigits() {
    if (!isAt(kDigits)) return fail("a digit is expected");
    while (isAt(kDigits)) ++at_;
    return true;
  }
  bool readNumber() {
    (void)take('-');
    if (!take('0') && !readDigits()) return false;
    if (isAt(kDigits)) return fail("a number does not begin with 0 and another digit");
    if (take('.') && !readDigits()) return false;
    if (!take('e') && !take('E')) return true;
    if (!take('+')) (void)take('-');
    return readDigits();
  }
  bool readWord(std::string_view word) {
    if (text_.substr(at_, word.size()) != word) return fail(std::string(word) + " is expected");
    at_ += word.size();
    return true;
  }

  const std::string_view text_;
  std::size_t at_ = 0;
  std::string error_;
};

}  // namespace

std::optional<std::string> checkJson(std::string_view json, const Descriptor& type) {
  return Checker(json).check(type);
}

}  // namespace spindrift::wire
