// SPDX-License-Identifier: GPL-3.0-or-later
#include <initializer_list>

#include "sim/controllers/motor.hpp"
#include "testing.hpp"

using vam::sim::MotorSettings;
using vam::sim::SimMotor;

TEST_CASE("The stage follows the trapezoidal speed profile") {
  SimMotor motor(MotorSettings{.acceleration_deg_s2 = 50}, 0);
  motor.set_speed(20);
  motor.go_to(100);
  // Ramp v/a = 0.4 s over v^2/2a = 4 deg, so at 2 s: 4 + 20 * 1.6 = 36 deg; whole way 100/20 + 0.4 = 5.4 s.
  // The 0.5 ms steps are worth 20 deg/s * 0.5 ms = 0.01 deg.
  motor.advance(2);
  CHECK(std::abs(motor.angle_deg() - 36) < 0.02);
  CHECK(motor.speed_deg_s() == doctest::Approx(20));
  motor.advance(5.3);
  CHECK(motor.moving());
  motor.advance(5.5);
  CHECK_FALSE(motor.moving());
  CHECK(motor.angle_deg() == 100);
}

TEST_CASE("Its path does not depend on the sampling") {
  MotorSettings settings{.ripple = 0.02};
  SimMotor often(settings, 0);
  SimMotor seldom(settings, 0);
  often.go_to(-77);
  seldom.go_to(-77);
  for (int i = 1; i <= 3000; ++i) often.advance(0.001 * i);
  seldom.advance(3.0);
  // 0.001 * i and 3.0 may fall on either side of one step of 0.5 ms.
  CHECK(std::abs(often.angle_deg() - seldom.angle_deg()) < 1e-6);
}

TEST_CASE("A stage at constant speed is where it was plus speed times time, at any moment") {
  SimMotor motor(MotorSettings{}, 0);
  motor.set_speed(60);
  motor.go_to(1000);
  motor.advance(2);
  const double there_deg = motor.angle_deg();
  for (const double later_s : {0.0001, 0.00049, 0.0012, 0.00789}) {
    motor.advance(2 + later_s);
    CHECK(motor.angle_deg() == doctest::Approx(there_deg + 60 * later_s).epsilon(1e-9));
  }
}

TEST_CASE("Smooth and abrupt stops take v/a") {
  for (const bool abrupt : {false, true}) {
    MotorSettings settings;
    SimMotor motor(settings, 0);
    motor.set_speed(30);
    motor.go_to(1000);
    motor.advance(2);
    abrupt ? motor.brake() : motor.halt();
    const double stop_s = 30 / (abrupt ? settings.brake_deg_s2 : settings.acceleration_deg_s2);
    motor.advance(2 + 0.8 * stop_s);
    CHECK(motor.moving());
    motor.advance(2 + 1.2 * stop_s);
    CHECK_FALSE(motor.moving());
  }
}
