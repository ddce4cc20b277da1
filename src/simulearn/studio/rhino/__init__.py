"""A script for Rhino 8 that asks the studio, and what it asks besides the REST API."""
