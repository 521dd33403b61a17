// QR codes on a terminal.
#pragma once

#include <string>

namespace spindrift::cli {

struct TerminalQr {
  std::string lines;
  int columns_count = 0;
};

/// Returns the QR code of a text as lines of half blocks, two modules above each other per character, black on white
/// whatever the colours of the terminal are (ECMA-48, 256 colours). No lines if the text is too long for a QR code.
TerminalQr terminalQr(const std::string& text);

/// Returns whether this file descriptor is a terminal that shows such lines: with colours, UTF-8 by the environment,
/// and at least this many columns.
bool showsQrCodes(int descriptor, int columns_count);

}  // namespace spindrift::cli
