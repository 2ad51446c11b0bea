"""The device port's LCM messages, and a device behind them."""
