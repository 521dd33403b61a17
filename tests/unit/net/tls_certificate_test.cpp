// Certificates: which ones a server takes, how a new one comes into use, and which ones clients accept.
#include <fstream>

#include <gmock/gmock.h>
#include <openssl/crypto.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <spindrift/net/client.h>

#include "certificates.h"
#include "temporary_folder.h"
#include "test_application.h"
#include "tls_client.h"
#include "tls_context.h"
#include "tls_credentials.h"

namespace spindrift::net {
namespace {

using namespace std::chrono_literals;
using test::CertificateFiles;
using test::eventually;
using test::TlsTcp;
using test::writeCertificate;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class Certificate : public testing::Test {
 protected:
  const std::filesystem::path& folder() const { return folder_.path(); }
  std::string reasonAgainst(const std::string& certificate, const std::string& key) const {
    const auto loaded = TlsContext::forServer(certificate, key);
    return loaded ? "" : loaded.error().message;
  }
  std::string file(const std::string& name, const std::string& text) const {
    folder_.write(name, text);
    return (folder() / name).string();
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(Certificate, WhatCannotBeUsedIsRefusedWithFileAndReason) {
  const CertificateFiles good = writeCertificate(folder(), "good");
  const CertificateFiles other = writeCertificate(folder(), "other");
  const CertificateFiles locked = writeCertificate(folder(), "locked", {.passphrase = "secret words"});
  EXPECT_EQ(reasonAgainst(good.certificate, good.key), "");
  EXPECT_EQ(reasonAgainst("/nonexistent.pem", good.key),
            "--tls-cert /nonexistent.pem: there is no such file; check the path");
  EXPECT_EQ(reasonAgainst(good.certificate, "/nonexistent.key"),
            "--tls-key /nonexistent.key: there is no such file; check the path");
  EXPECT_THAT(reasonAgainst(file("empty.pem", ""), good.key),
              AllOf(StartsWith("--tls-cert "), HasSubstr("empty.pem: "), HasSubstr("PEM form")));
  EXPECT_THAT(
      reasonAgainst(file("text.pem", "-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----\n"), good.key),
      HasSubstr("text.pem: "));
  EXPECT_THAT(reasonAgainst(good.key, good.key), AllOf(StartsWith("--tls-cert "), HasSubstr("good.key")));
  EXPECT_THAT(reasonAgainst(good.certificate, good.certificate),
              AllOf(StartsWith("--tls-key "), HasSubstr("good.pem")));
  EXPECT_THAT(reasonAgainst(good.certificate, other.key),
              AllOf(StartsWith("--tls-key "), HasSubstr("other.key: "), HasSubstr("good.pem")));
  EXPECT_EQ(reasonAgainst(locked.certificate, locked.key),
            "--tls-key " + locked.key + ": the key has a passphrase; give one without");
}

TEST_F(Certificate, AByteOrderMarkIsReadOver) {
  const CertificateFiles good = writeCertificate(folder(), "good");
  const auto withMark = [&](const std::string& name, const std::string& of) {
    std::ostringstream text;
    text << "\xEF\xBB\xBF" << std::ifstream(of).rdbuf();
    return file(name, text.str());
  };
  EXPECT_EQ(reasonAgainst(withMark("mark.pem", good.certificate), withMark("mark.key", good.key)), "");
  EXPECT_TRUE(TlsContext::forClient(withMark("authority.pem", good.certificate)));
  EXPECT_THAT(reasonAgainst(file("wide.pem", std::string("\xFF\xFE-\0", 4)), good.key), HasSubstr("is UTF-16 text"));
}

TEST_F(Certificate, AServerDoesNotStartWithOneThatCannotBeUsed) {
  const CertificateFiles good = writeCertificate(folder(), "good");
  test::TestApplication application;
  const auto started = Server::start({.port = 0, .tls = TlsFiles{good.certificate, "/nonexistent.key"}}, application);
  ASSERT_FALSE(started);
  EXPECT_THAT(started.error().message, StartsWith("--tls-key /nonexistent.key: "));
}

TEST_F(Certificate, ItsEndIsThatOfTheFirstOfTheChain) {
  const CertificateFiles leaf = writeCertificate(folder(), "leaf", {.ends_after_s = 7200});
  const CertificateFiles above = writeCertificate(folder(), "above", {.ends_after_s = 600});
  std::ofstream(leaf.certificate, std::ios::app) << std::ifstream(above.certificate).rdbuf();
  const auto context = TlsContext::forServer(leaf.certificate, leaf.key);
  ASSERT_TRUE(context) << context.error().message;
  const auto left = (*context)->expires - std::chrono::system_clock::now();
  EXPECT_GT(left, 500s);
  EXPECT_LE(left, 600s);
}

TEST_F(Certificate, AKeyThatEverybodyCanReadIsReported) {
  const auto words = std::make_shared<std::ostringstream>();
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("", std::make_shared<spdlog::sinks::ostream_sink_mt>(*words)));
  const CertificateFiles good = writeCertificate(folder(), "good");
  EXPECT_EQ(reasonAgainst(good.certificate, good.key), "");
  EXPECT_EQ(words->str(), "");
  ASSERT_EQ(::chmod(good.key.c_str(), S_IRUSR | S_IROTH), 0);
  EXPECT_EQ(reasonAgainst(good.certificate, good.key), "");
  spdlog::set_default_logger(before);
  EXPECT_THAT(words->str(), HasSubstr("every user of this machine can read the private key"));
}

/// The name in the certificate that a new connection gets; empty if there is no TLS.
std::string servedName(std::uint16_t port) {
  TlsTcp client;
  return client.connect(port) ? client.certificateName() : "";
}

class Reload : public Certificate {
 protected:
  void start(std::chrono::milliseconds watch_interval) {
    const CertificateFiles files = writeCertificate(folder(), "server", {.common_name = "first"});
    served_ = std::make_unique<test::TestServer>(
        ServerOptions{.tls = TlsFiles{files.certificate, files.key}, .tls_watch_interval = watch_interval});
  }
  void replace(const test::CertificateWish& wish) { writeCertificate(folder(), "server", wish); }
  Server& server() { return *served_->server; }

 private:
  std::unique_ptr<test::TestServer> served_;
};

TEST_F(Reload, NewConnectionsGetTheNewCertificateAndOldOnesStay) {
  start(1h);
  TlsTcp old;
  ASSERT_TRUE(old.connect(server().port()));
  replace({.common_name = "second", .ends_after_s = 1'000'000});
  EXPECT_EQ(servedName(server().port()), "first") << "nobody has asked for it";
  server().reloadCertificate();
  EXPECT_TRUE(eventually([&] { return servedName(server().port()) == "second"; }));
  EXPECT_EQ(old.certificateName(), "first");
  ASSERT_TRUE(old.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"));
  EXPECT_THAT(old.receiveAll(), HasSubstr("ok\n"));
  EXPECT_EQ(server().stats().tls_reload_count, 1u);
  EXPECT_GT(*server().stats().certificate_expires, std::chrono::system_clock::now() + 900'000s);
}

TEST_F(Reload, ChangedFilesAreNoticed) {
  start(20ms);
  replace({.common_name = "second"});
  EXPECT_TRUE(eventually([&] { return servedName(server().port()) == "second"; }));
}

TEST_F(Reload, FilesThatCannotBeUsedLeaveTheOldCertificateInUse) {
  start(20ms);
  file("server.pem", "half a certificate");
  EXPECT_TRUE(eventually([&] { return server().stats().failed_tls_reload_count == 1; }));
  EXPECT_EQ(servedName(server().port()), "first");
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(server().stats().failed_tls_reload_count, 1u) << "one report per change";
  replace({.common_name = "third"});
  EXPECT_TRUE(eventually([&] { return servedName(server().port()) == "third"; }));
}

TEST_F(Certificate, ThePairIsReadOnlyWhenBothFilesStandStill) {
  const CertificateFiles files = writeCertificate(folder(), "server");
  auto credentials = TlsCredentials::load({files.certificate, files.key});
  ASSERT_TRUE(credentials);
  const CertificateFiles next = writeCertificate(folder(), "next", {.common_name = "next"});
  std::filesystem::rename(next.certificate, files.certificate);
  (*credentials)->reloadIfChanged();  // the key is still the old one
  std::filesystem::rename(next.key, files.key);
  (*credentials)->reloadIfChanged();
  EXPECT_EQ((*credentials)->reloadCount() + (*credentials)->failureCount(), 0u);
  (*credentials)->reloadIfChanged();
  EXPECT_EQ((*credentials)->reloadCount(), 1u);
  (*credentials)->reloadIfChanged();
  EXPECT_EQ((*credentials)->reloadCount(), 1u);
  EXPECT_EQ((*credentials)->failureCount(), 0u);
}

class ClientTrust : public Certificate {
 protected:
  /// Returns why a client does not connect to `host`, or "" if it does. `wish`: the server's certificate.
  std::string refusal(const test::CertificateWish& wish, const std::string& host, bool trusts_it = true) {
    const CertificateFiles files = writeCertificate(folder(), "server", wish);
    const test::TestServer served(ServerOptions{.tls = TlsFiles{files.certificate, files.key}});
    const auto pool = ClientPool::create(0, trusts_it ? files.certificate : "");
    const auto url = ClientUrl::parse("wss://" + host + ":" + std::to_string(served.server->port()) + "/ws");
    std::optional<std::string> out;
    const auto client =
        pool->connect(*url, {},
                      {.opened = [&] { out = ""; },
                       .message = [](core::ByteView) {},
                       .closed = [&](std::uint16_t, const std::string& reason) { out = out.value_or(reason); }});
    pool->runFor(test::kPatience, [&] { return out.has_value(); });
    return out.value_or("no answer");
  }
};

TEST_F(ClientTrust, NamesAndAddressesOfTheCertificateAreAccepted) {
  EXPECT_EQ(refusal({}, "localhost"), "");
  EXPECT_EQ(refusal({}, "127.0.0.1"), "");
}

TEST_F(ClientTrust, AnyOtherHostIsRefused) {
  EXPECT_THAT(refusal({.alternative_names = "DNS:water.example"}, "localhost"), HasSubstr("hostname mismatch"));
  EXPECT_THAT(refusal({.alternative_names = "DNS:localhost"}, "127.0.0.1"), HasSubstr("IP address mismatch"));
}

TEST_F(ClientTrust, AnUnknownAuthorityIsRefused) {
  EXPECT_THAT(refusal({}, "localhost", false),
              AllOf(StartsWith("no TLS with localhost:"), HasSubstr("the certificate is not accepted: self-signed")));
}

TEST_F(ClientTrust, AnExpiredCertificateIsRefused) {
  EXPECT_THAT(refusal({.begins_after_s = -7200, .ends_after_s = -60}, "localhost"), HasSubstr("expired"));
}

TEST_F(ClientTrust, AFileWithoutAuthoritiesIsNamed) {
  const auto context = TlsContext::forClient(file("none.pem", "nothing"));
  ASSERT_FALSE(context);
  EXPECT_THAT(context.error().message, AllOf(StartsWith("--tls-ca "), HasSubstr("none.pem")));
  EXPECT_THAT(TlsContext::forClient("/nonexistent.pem").error().message,
              "--tls-ca /nonexistent.pem: there is no such file; check the path");
}

}  // namespace
}  // namespace spindrift::net
