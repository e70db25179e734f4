"""Flat arrays for a renderer that follow every edit."""
