// What a server prints for other devices: addresses, and QR codes on terminals.
#include "ready_text.h"

#include <algorithm>
#include <cstdlib>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include "command_line.h"
#include "terminal_qr.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class ReadyText : public CommandLineTest {
 protected:
  static std::string printed(const std::vector<std::string>& arguments) {
    return cli::readyText(CommandLine(arguments).options, 8080);
  }
  static std::string phoneUrl(const std::vector<std::string>& arguments) {
    return cli::phoneUrl(CommandLine(arguments).options, 8080);
  }
};

TEST_F(ReadyText, NamesTheAddressForOtherDevicesWhereThereIsOne) {
  EXPECT_THAT(printed({}), Not(HasSubstr("Phones")));
  EXPECT_THAT(printed({"--public-url", "https://water.example/sea"}),
              HasSubstr("Phones and other computers: https://water.example/sea/\n"));
  EXPECT_EQ(printed({"--address", "192.0.2.7"}), "Spindrift is ready: http://192.0.2.7:8080/\n") << "named already";
}

TEST_F(ReadyText, QrCodeIsThatOfThePageAndOfAClassThatOfThePad) {
  EXPECT_EQ(phoneUrl({}), "");
  EXPECT_EQ(phoneUrl({"--address", "192.0.2.7"}), "http://192.0.2.7:8080/");
  EXPECT_EQ(phoneUrl({"--class", "--address", "192.0.2.7"}), "http://192.0.2.7:8080/pad");
}

TEST(TerminalQr, HasAQuietZoneAndFinderPatternsOnWhite) {
  // 22 bytes fit version 2, 25 modules wide.
  const cli::TerminalQr code = cli::terminalQr("http://192.0.2.7:8080/");
  EXPECT_EQ(code.columns_count, 25 + 8);
  EXPECT_EQ(std::ranges::count(code.lines, '\n'), (25 + 8 + 1) / 2);
  const std::string white = "\x1b[38;5;16;48;5;231m";
  EXPECT_THAT(code.lines, StartsWith(white + std::string(33, ' ') + "\x1b[0m\n" + white + std::string(33, ' ') +
                                     "\x1b[0m\n" + white + "    \u2588\u2580\u2580\u2580\u2580\u2580\u2588 "));
  EXPECT_EQ(cli::terminalQr(std::string(3000, 'x')).lines, "") << "no QR code is so large";
}

class TerminalQrCodes : public CommandLineTest {
 protected:
  TerminalQrCodes() : terminal_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    set("TERM", "xterm");
    set("LC_ALL", "C.UTF-8");
  }
  ~TerminalQrCodes() override { ::close(terminal_); }
  const int terminal_;
};

TEST_F(TerminalQrCodes, AreForTerminalsWithColoursAndUtf8Only) {
  ASSERT_GE(terminal_, 0);
  EXPECT_TRUE(cli::showsQrCodes(terminal_, 33));
  set("TERM", "dumb");
  EXPECT_FALSE(cli::showsQrCodes(terminal_, 33));
  set("TERM", "xterm");
  set("LC_ALL", "C");
  EXPECT_FALSE(cli::showsQrCodes(terminal_, 33));
  set("LC_ALL", "C.UTF-8");
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  EXPECT_FALSE(cli::showsQrCodes(pipe[1], 33));
  for (const int end : pipe) ::close(end);
}

}  // namespace
}  // namespace spindrift::test
