(** * Floquet coordinates: only the foreign kicks are work

    Unit of time: the base clock's step, so its kicks of strength s stand at the integers. On the segment
    t = n + sigma, 0 <= sigma <= 1, two solutions of the base chain are piecewise linear between the values of

        C_0 = 1, C_1 = 1 - s/2,   S_0 = 0, S_1 = 1,   X_(n+2) = (2 - s) X_(n+1) - X_n    (any real s)

    the even one E(t) and the odd one O(t). Write x(t) = c E(t) + d O(t). A foreign kick of strength k does

        x = c E + d O;   c += k x O;   d -= k x E.

    - [wronskian]          E O' - O E' = 1 on every segment;
    - [update_kick]        the update is the kick, in position and velocity;
    - [foreign_kicks]      ... hence the product over any foreign kicks at increasing (real) times;
    - [foreign_ticks]      ... and over any foreign kicks on the ticks of a half period, halves at its ends.

    The trigonometric form of these coordinates is in TanCriterion.v.                                *)

From Kickdrift Require Import Vocabulary Algebra TwoClocks Stability.
From Coq Require Import Reals List Arith Lia Lra Psatz.
Import ListNotations.
Open Scope R_scope.

(** ** The base chain *)

Definition Cn (s : R) (n : nat) := three_term (2 - s) 1 (1 - s / 2) n.
Definition Sn (s : R) (n : nat) := three_term (2 - s) 0 1 n.
Definition even (s : R) (n : nat) (x : R) := (1 - x) * Cn s n + x * Cn s (S n).
Definition odd (s : R) (n : nat) (x : R) := (1 - x) * Sn s n + x * Sn s (S n).

(** Positions and velocities of the even and the odd solution on segment n. *)
Definition W (s : R) (n : nat) (x : R) :=
  Mat (even s n x) (odd s n x) (Cn s (S n) - Cn s n) (Sn s (S n) - Sn s n).

Definition update (k e o : R) := Mat (1 + k * e * o) (k * o * o) (- (k * e * e)) (1 - k * e * o).

Lemma update_act k e o c d :
  let x := c * e + d * o in
  update k e o @ Vec c d = Vec (c + k * x * o) (d - k * x * e).
Proof. intros x; unfold x, act; simpl; f_equal; ring. Qed.

Lemma update_zero e o : update 0 e o = one.                        Proof. matrix_ring. Qed.
Lemma update_add k l e o : update k e o ** update l e o = update (k + l) e o. Proof. matrix_ring. Qed.

Lemma Cn_step s n : Cn s (S (S n)) = (2 - s) * Cn s (S n) - Cn s n.  Proof. apply three_term_step. Qed.
Lemma Sn_step s n : Sn s (S (S n)) = (2 - s) * Sn s (S n) - Sn s n.  Proof. apply three_term_step. Qed.

Theorem wronskian s n x : det (W s n x) = 1.
Proof.
  enough (H : Cn s n * Sn s (S n) - Sn s n * Cn s (S n) = 1) by (unfold det, W, even, odd; simpl; lra).
  induction n as [|n IH]; [unfold Cn, Sn; simpl; ring|].
  rewrite Cn_step, Sn_step, <- IH; ring.
Qed.

Lemma W_start s : W s 0 0 = kick (s / 2).
Proof. apply mat_ext; unfold W, even, odd, Cn, Sn; simpl; field. Qed.

Lemma W_drift s n x t : drift t ** W s n x = W s n (x + t).
Proof. apply mat_ext; unfold W, even, odd; simpl; ring. Qed.

Lemma W_kick s n : kick s ** W s n 1 = W s (S n) 0.
Proof. apply mat_ext; unfold W, even, odd; simpl mA; simpl mB; simpl mC; simpl mD;
  rewrite ?Cn_step, ?Sn_step; ring. Qed.

Theorem update_kick s n x k : kick k ** W s n x = W s n x ** update k (even s n x) (odd s n x).
Proof.
  pose proof (wronskian s n x) as D; unfold det in D; simpl in D.
  apply mat_ext; simpl; [ring | ring | |].
  - transitivity ((Cn s (S n) - Cn s n) - k * even s n x *
      (even s n x * (Sn s (S n) - Sn s n) - odd s n x * (Cn s (S n) - Cn s n))); [rewrite D; ring | ring].
  - transitivity ((Sn s (S n) - Sn s n) - k * odd s n x *
      (even s n x * (Sn s (S n) - Sn s n) - odd s n x * (Cn s (S n) - Cn s n))); [rewrite D; ring | ring].
Qed.

(** ** Foreign kicks at any times n + x, given as (n, x, k) *)

(** From (n, x) to (n + m, y): the base kicks at n + 1, ..., n + m lie between. *)
Fixpoint travel (s x : R) (m : nat) (y : R) : list step :=
  match m with
  | O => [Drift (y - x)]
  | S m' => Drift (1 - x) :: Kick s :: travel s 0 m' y
  end.

Fixpoint foreign_schedule (s : R) (n : nat) (x : R) (kicks : list (nat * R * R)) : list step :=
  match kicks with
  | [] => []
  | (n', x', k) :: rest => travel s x (n' - n) x' ++ Kick k :: foreign_schedule s n' x' rest
  end.

Fixpoint in_order (n : nat) (kicks : list (nat * R * R)) : Prop :=
  match kicks with [] => True | (n', _, _) :: rest => (n <= n')%nat /\ in_order n' rest end.

Fixpoint last_time (n : nat) (x : R) (kicks : list (nat * R * R)) : nat * R :=
  match kicks with [] => (n, x) | (n', x', _) :: rest => last_time n' x' rest end.

Fixpoint foreign_updates (s : R) (kicks : list (nat * R * R)) : mat :=
  match kicks with
  | [] => one
  | (n, x, k) :: rest => foreign_updates s rest ** update k (even s n x) (odd s n x)
  end.

Lemma travel_W s n x m y : propagator (travel s x m y) ** W s n x = W s (n + m) y.
Proof.
  revert n x; induction m as [|m IH]; intros n x; simpl.
  - rewrite mul_one_l, W_drift, Nat.add_0_r; f_equal; ring.
  - rewrite <- !mul_assoc, W_drift; replace (x + (1 - x)) with 1 by ring.
    rewrite W_kick, IH; f_equal; lia.
Qed.

Theorem foreign_kicks s n x kicks :
  in_order n kicks ->
  let (n', x') := last_time n x kicks in
  propagator (foreign_schedule s n x kicks) ** W s n x = W s n' x' ** foreign_updates s kicks.
Proof.
  revert n x; induction kicks as [|[[n1 x1] k] rest IH]; intros n x; simpl.
  - now rewrite mul_one_l, mul_one_r.
  - intros [L O]; specialize (IH n1 x1 O); destruct (last_time n1 x1 rest) as [n' x'].
    rewrite propagator_app; simpl; rewrite <- !mul_assoc, travel_W.
    replace (n + (n1 - n))%nat with n1 by lia.
    now rewrite update_kick, mul_assoc, IH, mul_assoc.
Qed.

(** ** Foreign kicks g on the ticks, 2q ticks a segment *)

Section Ticks.
Variables (s : R) (q : nat) (g : nat -> R).
Hypothesis q_pos : (1 <= q)%nat.

Let seg (j : nat) := (j / (2 * q))%nat.
Let frac (j : nat) := INR (j mod (2 * q)) / (2 * INR q).
Definition E_at (j : nat) := even s (seg j) (frac j).
Definition O_at (j : nat) := odd s (seg j) (frac j).
Definition base (j : nat) := if strikes q false j then s else 0.

Fixpoint updates (j : nat) : mat :=
  match j with
  | O => one
  | S i => update (g (S i) / 2) (E_at (S i)) (O_at (S i)) ** update (g i / 2) (E_at i) (O_at i) ** updates i
  end.

Lemma tick_succ j : kick (base (S j)) ** drift (1 / (2 * INR q)) ** W s (seg j) (frac j)
                    = W s (seg (S j)) (frac (S j)).
Proof.
  assert (Q : 0 < INR q) by (apply lt_0_INR; lia).
  assert (M : (2 * q <> 0)%nat) by lia.
  rewrite <- mul_assoc, W_drift.
  pose proof (Nat.div_mod j (2 * q) M) as D; pose proof (Nat.mod_upper_bound j (2 * q) M) as B.
  unfold base, strikes; rewrite Nat.add_0_r.
  destruct (Nat.eq_dec (S (j mod (2 * q))) (2 * q)) as [E|N].
  - assert (D' : (S j = 2 * q * S (seg j) + 0)%nat) by (unfold seg; nia).
    assert (E1 : (S j / (2 * q) = S (seg j))%nat) by (symmetry; apply (Nat.div_unique _ _ _ 0); lia).
    assert (E2 : (S j mod (2 * q) = 0)%nat) by (symmetry; apply (Nat.mod_unique _ _ (S (seg j))); lia).
    rewrite E2; simpl (0 =? 0); cbv iota.
    replace (frac j + 1 / (2 * INR q)) with 1.
    + rewrite W_kick; unfold seg, frac; rewrite E1, E2; f_equal; simpl; field; lra.
    + unfold frac; replace (2 * INR q) with (INR (2 * q)) by (rewrite mult_INR; simpl; ring).
      rewrite <- E at 3; rewrite S_INR.
      replace (INR (2 * q)) with (INR (j mod (2 * q)) + 1) by (rewrite <- S_INR; now rewrite E).
      field; rewrite <- S_INR; apply not_0_INR; lia.
  - assert (E1 : (S j / (2 * q) = seg j)%nat)
      by (symmetry; apply (Nat.div_unique _ _ _ (S (j mod (2 * q)))); unfold seg; lia).
    assert (E2 : (S j mod (2 * q) = S (j mod (2 * q)))%nat)
      by (symmetry; apply (Nat.mod_unique _ _ (seg j)); unfold seg; lia).
    rewrite E2; simpl (S _ =? 0); cbv iota; rewrite kick_zero, mul_one_l.
    unfold seg at 2, frac at 2; rewrite E1, E2, S_INR; f_equal; unfold frac; field; lra.
Qed.

Theorem foreign_ticks j :
  propagator (schedule (fun i => base i + g i) (1 / (2 * INR q)) j)
  = kick (- (base j / 2)) ** W s (seg j) (frac j) ** updates j.
Proof.
  induction j as [|j IH].
  - assert (Q : 0 < INR q) by (apply lt_0_INR; lia).
    assert (Z : W s (seg 0) (frac 0) = kick (s / 2)).
    { rewrite <- W_start; unfold seg, frac; rewrite Nat.mod_0_l, Nat.div_0_l by lia; f_equal; simpl; field; lra. }
    assert (B : base 0 = s) by (unfold base, strikes; now rewrite Nat.mod_0_l by lia).
    rewrite Z, B, kick_add; simpl; now rewrite Rplus_opp_l, kick_zero, !mul_one_r.
  - rewrite propagator_schedule_succ, IH; simpl updates.
    transitivity (kick (g (S j) / 2) ** kick (- (base (S j) / 2)) ** (kick (base (S j)) ** drift (1 / (2 * INR q)) **
      (kick (g j / 2) ** W s (seg j) (frac j))) ** updates j).
    + generalize (W s (seg j) (frac j)) (updates j) (1 / (2 * INR q)); intros V P d; apply mat_ext; simpl; field.
    + rewrite update_kick; fold (E_at j) (O_at j).
      rewrite (mul_assoc _ (W s (seg j) (frac j))), tick_succ.
      rewrite kick_add, (Rplus_comm (g (S j) / 2)), <- kick_add, <- !mul_assoc.
      rewrite (mul_assoc (kick (g (S j) / 2))), update_kick; fold (E_at (S j)) (O_at (S j)).
      now rewrite !mul_assoc.
Qed.
End Ticks.
