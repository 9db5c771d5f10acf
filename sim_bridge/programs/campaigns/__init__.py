"""Campaigns: many games of scenarios, strategies, parameters and seeds, in a folder of shards that lasts."""
