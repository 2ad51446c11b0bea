"""One axis of a device behind a servo, while the loop that feeds it stalls.

Simulated time: no clock, the same on every machine. The servo is that of the package.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm

from drake_haptics._core import ServoLaw

MASS_KG, DAMPING_NS_PER_M = 0.1, 0.5
WALL_DAMPING_NS_PER_M = 1.0
MAX_FORCE_N = 8.5
HOLD_S, RELEASE_S = 0.02, 0.02
STALL_PERIOD_S = 1.0  # one stall each, from the first second on
DURATION_S = 4.0
WINDOW_S = 0.1  # before a stall: what moves there is not the stall's own doing
NOMINAL_HAND = (0.2, 5.0, 300.0)  # kg, N·s/m, N/m
PUSHED_IN_M = 0.01  # where the hand wants the handle, behind the wall
FOREVER_S = 1e9


@dataclass(frozen=True)
class Scheme:
    """A way to answer the device.

    Attributes:
        name: Name in tables.
        servo_hz: Rate of the device and of its answers.
        slopes: Whether the wrench has its slopes.
        hold_s: Time after which a wrench is released, s.
        brakes: Whether a wrench that comes back is damped.
        one_sided: Whether the force stays on the side of the wrench that was given.
    """

    name: str
    servo_hz: float = 1000.0
    slopes: bool = True
    hold_s: float = HOLD_S
    brakes: bool = True
    one_sided: bool = False


HELD = Scheme("held force", slopes=False, hold_s=FOREVER_S)
LOCAL = Scheme("local wrench", hold_s=FOREVER_S)
SERVO = Scheme("servo, 1 kHz")
FAST_SERVO = Scheme("servo, 4 kHz", servo_hz=4000.0)
UNBRAKED = Scheme("servo, unbraked", brakes=False)
ONE_SIDED = Scheme("servo, one-sided", one_sided=True)
SCHEMES = (HELD, LOCAL, SERVO, FAST_SERVO)


@dataclass(frozen=True)
class Run:
    """The course of a run, one entry per sample of the device.

    Attributes:
        time_s: Time of the sample, s.
        x_m: Position of the handle.
        force_N: Force that is shown.
        age_s: Age of the loop's last tick, s.
        delay_s: Time from a sample to the force that answers it, s.
    """

    time_s: np.ndarray
    x_m: np.ndarray
    force_N: np.ndarray
    age_s: np.ndarray
    delay_s: float

    def calc_buzz(self) -> float:
        """Returns the largest motion, peak to peak, just before the last stalls, m."""
        rate = 1.0 / self.time_s[1]
        ends = rate * np.arange(3.0, DURATION_S + 0.5, STALL_PERIOD_S)
        return max(
            np.ptp(self.x_m[round(i - WINDOW_S * rate) : round(i)]) for i in ends
        )

    def calc_stale_force(self) -> float:
        """Returns the largest force later than hold and release after a tick, N."""
        stale = self.age_s > HOLD_S + RELEASE_S + self.delay_s + 1e-9
        return float(np.abs(self.force_N[stale]).max(initial=0.0))


def simulate(
    scheme: Scheme,
    stiffness: float,
    loop_hz: float,
    stall_s: float,
    *,
    hand: tuple[float, float, float] | None = None,
    delay: int = 1,
    stall_period_s: float = STALL_PERIOD_S,
    duration_s: float = DURATION_S,
) -> Run:
    """Simulates a handle on a spring of the scene.

    Without a hand the spring acts both ways, as in a slot, and the handle begins 2 mm
    from its middle: nothing else ends a motion. With a hand it is a wall that only
    pushes, and the hand presses on it.

    Args:
        scheme: Way to answer.
        stiffness: Stiffness of the spring, N/m.
        loop_hz: Rate of the loop that computes wrenches.
        stall_s: Length of a stall, once per `stall_period_s`.
        hand: Mass, damping and stiffness.
        delay: Samples of the device until an answer is shown.
        stall_period_s: Time from stall to stall, s.
        duration_s: Duration of the run, s.
    """
    dt = 1.0 / scheme.servo_hz
    flow, rest = make_flow(hand, dt)
    samples, every = round(duration_s / dt), round(scheme.servo_hz / loop_hz)
    law = ServoLaw(
        max_force_N=MAX_FORCE_N,
        max_torque_Nm=0.0,
        hold_s=scheme.hold_s,
        release_s=RELEASE_S,
        # Before there was a release there was no way back from it either.
        engage_s=0.2 if scheme.hold_s < FOREVER_S else 1e-9,
    )
    X, V, F = np.eye(7)[0], np.zeros(6), np.zeros(6)
    K, B = np.zeros((6, 6)), np.zeros((6, 6))
    x, v = (2e-3, 0.0) if hand is None else (-5e-3, 0.0)
    waiting = [0.0] * delay
    out = np.empty((samples, 3))
    last_tick = 0.0
    for i in range(samples):
        now = i * dt
        stalled = now >= stall_period_s and now % stall_period_s < stall_s - 1e-9
        X[4], V[3] = x, v
        if i % every == 0 and not stalled:
            touches = hand is None or stiffness * x + WALL_DAMPING_NS_PER_M * v > 0 < x
            K[3, 3] = touches * stiffness
            B[3, 3] = touches * WALL_DAMPING_NS_PER_M
            F[3] = np.clip(-K[3, 3] * x - B[3, 3] * v, -MAX_FORCE_N, MAX_FORCE_N)
            slopes = (K, B) if scheme.slopes else (None, None)
            law.adopt(F, X, V, *slopes, now)
            last_tick = now
        force = law.step(now, X, V)[3]
        if not scheme.brakes:
            force += 16.0 * law.scale * (1.0 - law.scale) * v
        if scheme.one_sided and force * F[3] < 0.0:
            force = 0.0
        waiting.append(force)
        force = waiting.pop(0)
        out[i] = x, force, now - last_tick
        x, v, _ = flow @ (x - rest, v, force)
        x += rest
    return Run(dt * np.arange(samples), *out.T, delay_s=delay * dt)


def make_flow(
    hand: tuple[float, float, float] | None, dt: float
) -> tuple[np.ndarray, float]:
    """Returns the exact map of [x - rest; v; force] over a sample, and `rest`, m."""
    m, b, k = hand or (0.0, 0.0, 0.0)
    m, b = m + MASS_KG, b + DAMPING_NS_PER_M
    A = np.array([[0, 1, 0], [-k / m, -b / m, 1 / m], [0, 0, 0]])
    return expm(dt * A), PUSHED_IN_M if hand else 0.0
