"""A body on a pivot that torques are to raise and to hold: an environment of Gymnasium, `gymnasium.make("Raised-v0")`."""

import gymnasium as gym
import numpy as np

import liestep as ls

BODY = ls.body([1, 1, 0.1], kinetic="cayley") + ls.gravity(m=1, rho=[0, 0, 1])


class Raised(gym.Env):
    """Actions are torques in the axes of the body, as shares of the largest, N m; observed are the vertical and the velocity."""

    def __init__(self, step=0.02, most=5.0):
        self.stepper, self.most = BODY.stepper(step), most
        self.action_space = gym.spaces.Box(-1.0, 1.0, (3,), np.float64)
        self.observation_space = gym.spaces.Box(-np.inf, np.inf, (6,), np.float64)

    def observed(self):
        return np.concatenate([self.state.attitude[2], self.state.velocity])

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        tilt = (options or {}).get("tilt", self.np_random.uniform(3.0, np.pi))
        self.state = self.stepper.start(attitude=ls.euler(0, tilt), velocity=self.np_random.normal(0, 0.1, 3))
        return self.observed(), {}

    def step(self, action):
        self.state.step(torque=self.most * np.clip(action, -1, 1))
        height = float(self.state.attitude[2, 2])
        return self.observed(), height - 0.01 * float(action @ action), False, False, {"energy": self.state.energy}


gym.register("Raised-v0", entry_point=Raised, max_episode_steps=500)
