"""The podium study of Bantilas, Kavvadias and Vasiliadis: nine buildings, two laws of impact,
near-fault motions, and its claims judged.
"""
