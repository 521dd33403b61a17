#pragma once

#include <compare>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

namespace spindrift::textproto {

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

/// The text form of a message, read as far as possible.
class ParsedText {
 public:
  /// Reads `text` into `message` and collects every syntax error, unknown field and wrong type. Braces may nest 32
  /// deep.
  ParsedText(std::string text, google::protobuf::Message& message);

  bool hasErrors() const { return !errors_.empty(); }
  /// Adds what is wrong with the field at a path ("events[1].effect.splash"), at its place or, if it was left out, at
  /// that of its innermost part.
  void addError(std::string_view path, std::string_view message);
  /// Returns the errors, at most 100, with `label`, usually the file's name, and their places, one per line in the
  /// order of the text.
  std::string report(const std::string& label) const;

 private:
  Location locate(std::string_view path) const;

  const google::protobuf::Descriptor* type_;
  std::unique_ptr<google::protobuf::TextFormat::ParseInfoTree> tree_;
  std::vector<LocatedError> errors_;
};

}  // namespace spindrift::textproto
