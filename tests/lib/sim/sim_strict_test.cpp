// SPDX-License-Identifier: GPL-3.0-or-later
// The simulators against their makers' documents, byte by byte and without our backends: a case for each behaviour that
// a driver might believe otherwise. The sources are named in lib/sim/controllers.
#include <map>
#include <memory>

#include "base/text/json.hpp"
#include "device/os/clock.hpp"
#include "sim/controllers/controllers.hpp"
#include "sim/controllers/dlp.hpp"
#include "sim/controllers/tic.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::sim;

namespace {

using Make = std::unique_ptr<SimDevice> (*)(const SimGcsSettings&, double, SimLog);

// A terminal on a controller's line, with a clock of its own.
class Terminal {
 public:
  explicit Terminal(Make make, const SimGcsSettings& settings = {}) : device_(make(settings, 0, nullptr)) {}
  // What comes within 10 ms.
  std::string operator()(const std::string& bytes) {
    device_->receive(bytes, now_s_);
    wait(0.01);
    return device_->take(now_s_);
  }
  void wait(double seconds) {
    now_s_ += seconds;
    device_->advance(now_s_);
  }
  // What has come by itself.
  std::string heard() {
    wait(0.01);
    return device_->take(now_s_);
  }

 private:
  std::unique_ptr<SimDevice> device_;
  double now_s_ = 0;
};

Terminal gcs(int address = 1) { return Terminal(make_sim_gcs, SimGcsSettings{.address = address}); }

bool begins(const std::string& text, const std::string& with) { return text.rfind(with, 0) == 0; }

// A report of TI's HID protocol: flags, sequence, length, CMD3, CMD2, data; and the answer.
std::string ask_dlp(device::UsbLink& link, int flags, int command, const std::string& data) {
  std::string report{static_cast<char>(flags),           '\5',
                     static_cast<char>(data.size() + 2), '\0',
                     static_cast<char>(command & 0xFF),  static_cast<char>(command >> 8)};
  report += data;
  report.resize(64, '\0');
  link.write_report(report);
  return link.read_report();
}

double red_percent(bool dlpc900, const std::string& polarity, char current) {
  double percent = -1;
  const auto link = make_sim_dlp({.dlpc900 = dlpc900}, [&](const Json& line) {
    if (line["event"] == "leds") percent = line["current_percent"][0];
  });
  ask_dlp(*link, 0x40, 0x1A05, polarity);
  ask_dlp(*link, 0x40, 0x0B01, std::string(3, current));
  ask_dlp(*link, 0x40, 0x1A07, std::string(1, '\1'));
  return percent;
}

}  // namespace

TEST_CASE("GCS: only questions are answered, and ERR? clears") {
  Terminal say = gcs();
  CHECK(say("MOV 1 10\n").empty());
  CHECK(say("ERR?\n") == "5\n");
  CHECK(say("ERR?\n") == "0\n");
  CHECK(begins(say("SVO? 1\n"), "1=0"));
}

TEST_CASE("GCS: without servo or reference nothing moves") {
  Terminal say = gcs();
  CHECK(say("FRF 1\nERR?\n") == "5\n");
  say("SVO 1 1\n");
  CHECK(say("MOV 1 10\nERR?\n") == "5\n");
  CHECK(say("FRF? 1\n") == "1=0\n");
  say("FRF 1\n");
  CHECK(say("\x07") == "\xB0\n");
  say.wait(5);
  CHECK(say("\x07") == "\xB1\n");
  CHECK(say("MOV 1 10\nERR?\n") == "0\n");
  CHECK(say("\x05") == "1\n");
}

TEST_CASE("GCS: a position is set in reference mode 0 only, and at rest; codes 88, 93 and 50 of the maker's list") {
  Terminal say = gcs();
  say("SVO 1 1\n");
  CHECK(say("POS 1 0\nERR?\n") == "88\n");
  CHECK(say("RON 1 0\nFRF 1\nERR?\n") == "50\n");
  CHECK(say("POS 1 0\nERR?\n") == "0\n");
  CHECK(say("MOV 1 30\nPOS 1 0\nERR?\n") == "93\n");
}

TEST_CASE("GCS: error codes of impossible commands: 2, 7, 8, 15, 24, 25, 54") {
  Terminal say = gcs();
  say("SVO 1 1\nRON 1 0\nPOS 1 0\n");
  const std::map<std::string, std::string> codes{{"ABC 1 1", "2"},     {"MOV 1 1e6", "7"}, {"VEL 1 1000", "8"},
                                                 {"MOV 2 1", "15"},    {"MOV 1", "24"},    {"MOV 1 ten", "25"},
                                                 {"SPA? 1 0x99", "54"}};
  for (const auto& [command, code] : codes) CHECK_MESSAGE(say(command + "\nERR?\n") == code + "\n", command);
}

TEST_CASE("GCS: in a chain a controller hears its own address only, single bytes included") {
  Terminal say = gcs(3);
  CHECK(say("POS? 1\n").empty());
  CHECK(say("\x05").empty());
  CHECK(say("2 POS? 1\n").empty());
  CHECK(begins(say("3 POS? 1\n"), "0 3 1="));
  CHECK(begins(say("3 \x05"), "0 3 0"));
  say("3 SVO 1 1\n3 RON 1 0\n3 POS 1 0\n3 VEL 1 20\n3 MOV 1 90\n");
  say.wait(1);
  say("\x18");  // somebody else's
  CHECK(begins(say("3 \x05"), "0 3 1"));
  say("3 \x18");
  say.wait(1);
  CHECK(begins(say("3 \x05"), "0 3 0"));
  CHECK(begins(say("3 ERR?\n"), "0 3 10"));
}

TEST_CASE("GCS: units and the lines of HLP? as the controller writes them") {
  Terminal say = gcs();
  CHECK(say("PUN? 1\n") == "1=DEG\n");  // capitals, unlike other models
  const std::string help = say("HLP?\n");
  CHECK(has(help, " \n"));
  CHECK(help.substr(help.size() - 2) != " \n");
}

TEST_CASE(
    "GRBL: real-time bytes act inside a line and get no ok; a board that was reset greets and has lost its place") {
  Terminal say(make_sim_grbl, SimGcsSettings{.reset_at_open = true});
  CHECK(begins(say("\n"), "\r\nGrbl 1.1"));
  CHECK(begins(say("$?"), "<Idle|MPos:0.000"));
  CHECK(has(say("X\n"), "ok\r\n"));
  CHECK(say("hello\n") == "error:20\r\n");
  CHECK(say("$J=G53 G90 X1e7 F600\n") == "error:15\r\n");
  CHECK(say("$J=G53 G90 X90 F600\n") == "ok\r\n");
  CHECK(has(say("\x18"), "Grbl 1.1"));
  CHECK(begins(say("?"), "<Alarm"));
  CHECK(say("$J=G53 G90 X0 F600\n") == "error:9\r\n");
}

TEST_CASE("GRBL: reports wait until homing is over, and so does its ok") {
  Terminal say(make_sim_grbl);
  CHECK(say("$H\n").empty());
  CHECK(say("?").empty());
  say.wait(5);
  const std::string text = say.heard();
  CHECK(begins(text, "<Idle|MPos:0.000"));
  CHECK(has(text, "ok\r\n"));
}

TEST_CASE("Zaber: device 0 or no number addresses all devices, the message number is returned, WR lasts until homing") {
  Terminal say(make_sim_zaber, SimGcsSettings{.address = 2});
  CHECK(say("/1 get pos\n").empty());
  CHECK(begins(say("/0 get version\n"), "@02 0 OK IDLE WR"));
  CHECK(begins(say("/2 1 07 get limit.cycle.dist\r"), "@02 1 07 OK IDLE WR 384000\r\n"));
  CHECK(begins(say("/2 1 move abs 100\n"), "@02 1 RJ IDLE WR BADDATA"));
  CHECK(begins(say("/2 2 get pos\n"), "@02 2 RJ IDLE WR BADAXIS"));
  CHECK(begins(say("/2 1 fly\n"), "@02 1 RJ IDLE WR BADCOMMAND"));
  CHECK(begins(say("/2 1 home\n"), "@02 1 OK BUSY WR"));
  say.wait(5);
  CHECK(begins(say.heard(), "!02 1 IDLE --"));  // comm.alert
  CHECK(begins(say("/2 1 warnings\n"), "@02 1 OK IDLE -- 00"));
}

TEST_CASE("Zaber: microsteps are whole, and a speed follows a motion from firmware 7.25 on") {
  for (const bool old : {false, true}) {
    Terminal say(make_sim_zaber, SimGcsSettings{.old_firmware = old});
    say("/1 1 home\n");
    say.wait(5);
    say.heard();
    CHECK(begins(say("/1 1 move abs 10.5\n"), "@01 1 RJ"));
    CHECK(begins(say("/1 1 move abs 100 5000\n"), old ? "@01 1 RJ" : "@01 1 OK BUSY"));
  }
}

TEST_CASE("The relay opens by itself 300 ms after the last heartbeat, and no heartbeat closes it") {
  Terminal say(make_sim_relay);
  CHECK(begins(say("?"), "vam-relay 1 300"));
  CHECK(say("H") == "open\r\n");
  CHECK(say("A") == "closed\r\n");
  say.wait(0.25);
  CHECK(say("H") == "closed\r\n");
  say.wait(0.35);
  CHECK(say("H") == "open\r\n");
  CHECK(say("A") == "closed\r\n");
}

TEST_CASE("Tic: power-on is de-energised, unsafe and of uncertain position; halt and hold makes it uncertain again") {
  device::VirtualClock clock;
  const auto tic = make_sim_tic({}, clock, nullptr);
  const auto flags = [&] { return static_cast<unsigned char>(tic->control_in(0xA1, 0, 0x01, 1).at(0)); };
  const auto moving = [&] {
    tic->control_out(0xE0, 1000, 0);
    clock.sleep_until(clock.now_s() + 0.2);
    return tic->control_in(0xA1, 0, 0x26, 4) != std::string(4, '\0');
  };
  CHECK(tic->control_in(0xA1, 0, 0x00, 1).at(0) == 2);  // de-energised
  CHECK(flags() == 2);                                  // uncertain
  tic->control_out(0xE6, 0x4240, 0x0F);                 // 1 000 000: 100 microsteps per second
  CHECK_FALSE(moving());
  tic->control_out(0x85, 0, 0);
  CHECK_FALSE(moving());  // safe start
  tic->control_out(0x83, 0, 0);
  CHECK(moving());
  tic->control_out(0xEC, 0, 0);
  CHECK(flags() == 1);
  CHECK(moving());
  tic->control_out(0x89, 0, 0);
  CHECK(flags() == 3);
  CHECK(fault_of([&] { tic->control_out(0x12, 0, 0); }) == Fault::protocol);
}

TEST_CASE("Tic: without a command for its time-out it stops") {
  device::VirtualClock clock;
  const auto tic = make_sim_tic({}, clock, nullptr);
  for (const int request : {0x85, 0x83}) tic->control_out(request, 0, 0);
  tic->control_out(0xE6, 0x4240, 0x0F);
  tic->control_out(0xE0, 0, 1);  // 65536 microsteps
  clock.sleep_until(clock.now_s() + 0.9);
  CHECK(tic->control_in(0xA1, 0, 0x26, 4) != std::string(4, '\0'));
  clock.sleep_until(clock.now_s() + 4);
  CHECK(tic->control_in(0xA1, 0, 0x26, 4) == std::string(4, '\0'));
}

TEST_CASE(
    "DLPC350: FF is no current at normal polarity on a LightCrafter 4500, full on a DLPC900, and inverted turns both") {
  CHECK(red_percent(false, std::string(1, '\0'), '\xFF') == 0);
  CHECK(red_percent(false, std::string(1, '\0'), '\0') == 100);
  CHECK(red_percent(false, std::string(1, '\1'), '\xFF') == 100);
  CHECK(red_percent(true, std::string(1, '\0'), '\xFF') == 100);
  CHECK(red_percent(true, std::string(1, '\1'), '\xFF') == 0);
}

TEST_CASE("DLPC: unknown commands and wrong lengths are refused, answers repeat the sequence number") {
  const auto link = make_sim_dlp({}, nullptr);
  CHECK((ask_dlp(*link, 0xC0, 0x1A0E, "").at(0) & 0x20) == 0);
  CHECK(ask_dlp(*link, 0xC0, 0x1A0E, "").at(1) == 5);
  CHECK((ask_dlp(*link, 0xC0, 0x1A0E, "").at(4) & 0x80) != 0);  // gamma is on as delivered
  CHECK((ask_dlp(*link, 0x40, 0x1A99, "1").at(0) & 0x20) != 0);
  CHECK((ask_dlp(*link, 0x40, 0x1A07, "12").at(0) & 0x20) != 0);
  const auto other = make_sim_dlp({.dlpc900 = true}, nullptr);
  CHECK((ask_dlp(*other, 0xC0, 0x1A0E, "").at(0) & 0x20) != 0);  // which has no gamma
}
