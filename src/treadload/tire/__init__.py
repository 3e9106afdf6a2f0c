"""tire"""
