//! Chi-square tests, furnace scenes and other instruments for tests.
