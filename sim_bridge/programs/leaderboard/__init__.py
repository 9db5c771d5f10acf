"""The leaderboard: every strategy of the pursuers against every evader over a fixed set of scenarios."""
