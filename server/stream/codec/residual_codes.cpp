#include "residual_codes.h"

#include <algorithm>

namespace spindrift::stream {
namespace {

/// Lengths of the symbols' codes, one digit each to the base of 16. Fours: r0 + 3 r1 + 9 r2 + 27 r3 with -1 as 0;
/// pairs: r0 + 9 r1 with -4 as 0; both with the escape at the end.
constexpr std::string_view kLengths[] = {
    "bbbbabbbbb9ba5bbbbbbbbbbbbbbbb86bbbbb5b616b5bbbbb58bbbbbbbbbbbbbbbb5ab9bbbbbabbbb2",
    "bbbb9bbbbb9b948b9bbbbb7bbbbb9b959b6b957515759b6b959b9bbbbb7bbbbb9b849b9bbbbb9bbbb4",
    "abbb8bbbbb9b959b8bbbbb6bbbba9b958b7b856515658b7b859b9abbbb6bbbbb8b849b9bbbbb8bbba4",
    "a9ba8bbbbb8b858a7bbaba6bbbb98b857a6b856515658b6a758b89bbbb6ababb7a758b8bbbbb8ab9a5",
    "a9ba8bbbba8b85897bb9a96bbbba8b85896b856515658b69758b8abbbb69a9bb79858b8abbbb8ab9a5",
    "bbbbbbbbbbbbb9bbbbbbb98bbbbbb9545bbbb9841489bbbb5359bbbbbb89bbbbbbb9bbbbbbbbbbbbb9",
    "bbbbbbbbbbbbbabbbbbba98abbbbb9534abbba83238abbba4358bbbbba89abbbbbbabbbbbbbbbbbbba",
    "bbbbbbbbbbbbabbbbbbb8778bbbba74348bbbb73337bbbb84346abbbb8778bbbbbbbabbbbbbbbbbbba",
    "a98642223589a9",
    "a987653232356789a9",
    "bbba988654333324567899bbb9",
    "bbbbba998775433434334567899aabbbbb",
    "bbbbbbbbba98877665544444444344556677889aabbbbbbbbb",
};
constexpr std::string_view kClassStepLengths[] = {
    "1256765566888775786",
    "1766665443556666777",
    "4977665422345567896",
};

std::vector<std::uint8_t> lengthsOf(std::string_view digits) {
  std::vector<std::uint8_t> lengths;
  for (const char digit : digits)
    lengths.push_back(static_cast<std::uint8_t>(digit >= 'a' ? digit - 'a' + 10 : digit - '0'));
  return lengths;
}

template <typename Code, typename Make>
ResidualCodes<Code> makeCodes(Make make) {
  ResidualCodes<Code> codes;
  for (const std::string_view digits : kLengths) codes.of_class.push_back(make(lengthsOf(digits)));
  for (const std::string_view digits : kClassStepLengths) codes.of_class_step.push_back(make(lengthsOf(digits)));
  return codes;
}

}  // namespace

const ResidualCodes<PrefixWriter>& residualWriters() {
  static const auto kCodes =
      makeCodes<PrefixWriter>([](const std::vector<std::uint8_t>& lengths) { return PrefixWriter(lengths); });
  return kCodes;
}

const ResidualCodes<PrefixReader>& residualReaders() {
  static const auto kCodes =
      makeCodes<PrefixReader>([](const std::vector<std::uint8_t>& lengths) { return *PrefixReader::create(lengths); });
  return kCodes;
}

}  // namespace spindrift::stream
