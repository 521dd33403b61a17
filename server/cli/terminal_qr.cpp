#include "terminal_qr.h"

#include <array>
#include <cstdlib>
#include <memory>
#include <string_view>

#include <qrencode.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace spindrift::cli {
namespace {

/// Modules of white around the code, which readers need (ISO/IEC 18004).
constexpr int kQuietModules = 4;
constexpr std::string_view kBlackOnWhite = "\x1b[38;5;16;48;5;231m", kPlain = "\x1b[0m";

/// Returns whether the environment's locale has UTF-8 as its encoding; the first variable that is set decides (POSIX).
bool isUtf8() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* const value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    const std::string_view text(value);
    return text.find("UTF-8") != std::string_view::npos || text.find("utf8") != std::string_view::npos;
  }
  return false;
}

}  // namespace

TerminalQr terminalQr(const std::string& text) {
  const std::unique_ptr<QRcode, decltype(&::QRcode_free)> code(::QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_L),
                                                               &::QRcode_free);
  if (!code) return {};
  const int width = code->width;
  const auto isBlack = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < width && y < width && (code->data[y * width + x] & 1U) != 0;
  };
  constexpr std::array<std::string_view, 4> kBlocks = {" ", "\u2580", "\u2584", "\u2588"};
  TerminalQr out{.lines = {}, .columns_count = width + 2 * kQuietModules};
  for (int y = -kQuietModules; y < width + kQuietModules; y += 2) {
    out.lines += kBlackOnWhite;
    for (int x = -kQuietModules; x < width + kQuietModules; ++x)
      out.lines += kBlocks[(isBlack(x, y) ? 1U : 0U) + (isBlack(x, y + 1) ? 2U : 0U)];
    out.lines += kPlain;
    out.lines += '\n';
  }
  return out;
}

bool showsQrCodes(int descriptor, int columns_count) {
  const char* const terminal = std::getenv("TERM");
  if (::isatty(descriptor) == 0 || !isUtf8() || terminal == nullptr || std::string_view(terminal) == "dumb")
    return false;
  winsize size{};
  // A terminal that does not know its size says 0.
  return ::ioctl(descriptor, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_col >= columns_count;
}

}  // namespace spindrift::cli
